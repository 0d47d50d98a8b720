#include "cli/command_process.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>

namespace rilo::test {

namespace {

constexpr std::chrono::seconds kLongest{120};  // a guard against hanging, far above what any test takes
constexpr std::chrono::milliseconds kPoll{2};
constexpr int kCannotStart = 127;

std::string command_file() {
  const char* file = std::getenv("RILO_BIN");
  if (file == nullptr) throw std::runtime_error("RILO_BIN does not name the command; run the tests through ctest");
  return file;
}

void redirect(int stream, const std::string& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (opened < 0 || ::dup2(opened, stream) < 0) ::_exit(kCannotStart);
}

}  // namespace

CommandProcess::CommandProcess(const std::vector<std::string>& arguments)
    : deadline_(std::chrono::steady_clock::now() + kLongest) {
  std::vector<std::string> words{command_file()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // Files rather than pipes: no output is long enough to block the command.
  const std::string out = streams_ / "out";
  const std::string err = streams_ / "err";
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("no process");
  if (pid_ == 0) {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    ::execv(argv[0], argv.data());
    ::_exit(kCannotStart);
  }
}

CommandProcess::~CommandProcess() {
  if (ended()) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, &status_, 0);
}

void CommandProcess::send(int signal) const { ::kill(pid_, signal); }

bool CommandProcess::ended() {
  if (!reaped_) reaped_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return reaped_;
}

bool CommandProcess::wait_until(const std::function<bool()>& condition) {
  while (std::chrono::steady_clock::now() < deadline_) {
    if (condition()) return true;
    if (ended()) return condition();  // it may have come true in between
    std::this_thread::sleep_for(kPoll);
  }
  return false;
}

Outcome CommandProcess::wait() {
  if (!wait_until([this] { return ended(); })) {
    ADD_FAILURE() << "the command hangs";
    send(SIGKILL);
    reaped_ = ::waitpid(pid_, &status_, 0) == pid_;
  }
  Outcome outcome;
  outcome.out = slurp(streams_ / "out");
  outcome.err = slurp(streams_ / "err");
  if (WIFEXITED(status_)) outcome.exit_code = WEXITSTATUS(status_);
  if (WIFSIGNALED(status_)) outcome.signal = WTERMSIG(status_);
  return outcome;
}

Outcome rilo_command(const std::vector<std::string>& arguments) { return CommandProcess(arguments).wait(); }

Outcome rilo_succeeds(const std::vector<std::string>& arguments) {
  Outcome outcome = rilo_command(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << "\n" << outcome.err;
  return outcome;
}

Outcome rilo_fails(int exit_code, const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
  Outcome outcome = rilo_command(arguments);
  const std::string what = testing::PrintToString(arguments) + "\n" + outcome.err;
  EXPECT_EQ(outcome.exit_code, exit_code) << what << (outcome.signal != 0 ? "ended by a signal" : "");
  EXPECT_EQ(lines_with(outcome.err, "rilo: error: ").size(), 1U) << what;
  SCOPED_TRACE(what);
  expect_parts(outcome.err, parts);
  return outcome;
}

void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

std::set<pid_t> children_of(pid_t parent) {
  const std::string number = std::to_string(parent);
  std::ifstream stream("/proc/" + number + "/task/" + number + "/children");
  std::set<pid_t> children;
  for (pid_t child = 0; stream >> child;) children.insert(child);
  return children;
}

std::vector<std::string> lines_of(const std::string& text) { return lines_with(text, ""); }

std::vector<std::string> lines_with(const std::string& text, std::string_view start) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(start)) lines.push_back(line);
  }
  return lines;
}

}  // namespace rilo::test
