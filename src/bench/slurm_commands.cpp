#include "bench/slurm_commands.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <set>
#include <sstream>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "console/failure.hpp"
#include "io/text.hpp"

namespace rilo {

namespace {

constexpr int kCannotStart = 127;

[[noreturn]] void become_program(const std::vector<std::string>& words, int to) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(to, STDOUT_FILENO);
  dup2(to, STDERR_FILENO);
  // Ctrl-C is for us: the program must reach its end. A group of its own does not get it.
  setpgid(0, 0);
  execvp(argv[0], argv.data());
  _exit(kCannotStart);
}

std::string trimmed_line(const std::string& text) {
  return std::string(detail::trimmed(detail::LineScanner(text).next().value_or("")));
}

// What follows "key=" up to the next blank.
std::string value_after(const std::string& text, const std::string& key) {
  const std::size_t begin = text.find(key + "=");
  if (begin == std::string::npos) return "";
  const std::size_t value = begin + key.size() + 1;
  return text.substr(value, text.find_first_of(" \n", value) - value);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) become_program(words, ends[1]);
  ::close(ends[1]);
  ProgramResult result;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
    if (count > 0) result.out.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) break;
  }
  ::close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
  return result;
}

std::vector<SlurmTask> parse_queue(const std::string& text) {
  std::vector<SlurmTask> tasks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    SlurmTask task;
    std::string index;
    std::getline(fields, task.array, '|');
    std::getline(fields, index, '|');
    std::getline(fields, task.state, '|');
    std::getline(fields, task.name);
    const auto number = detail::parse_unsigned(index);
    if (!number || !detail::parse_unsigned(task.array)) continue;
    task.index = *number;
    task.name = trimmed_line(task.name);
    tasks.push_back(task);
  }
  return tasks;
}

std::string index_ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (last > i) text += "-" + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

std::optional<std::vector<SlurmTask>> tasks_in_queue(const std::string& name) {
  const ProgramResult result = run_program({"squeue", "--noheader", "--array", "--me", "--format=%F|%K|%T|%j"});
  if (result.code == kCannotStart)
    throw RunError(RunErrorKind::kUsage, "--on slurm: there is no squeue; is Slurm installed?");
  if (result.code != 0) return std::nullopt;
  std::vector<SlurmTask> ours;
  for (const SlurmTask& task : parse_queue(result.out)) {
    if (task.name.starts_with(name)) ours.push_back(task);
  }
  return ours;
}

std::string submit_array(const std::filesystem::path& script, const std::string& name, const std::string& indices,
                         const std::filesystem::path& log, const std::vector<std::string>& options) {
  std::vector<std::string> words = {"sbatch",
                                    "--parsable",
                                    "--job-name=" + name,
                                    "--array=" + indices,
                                    "--output=" + log.string(),
                                    "--open-mode=append"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  const ProgramResult result = run_program(words);
  if (result.code == kCannotStart)
    throw RunError(RunErrorKind::kUsage, "--on slurm: there is no sbatch; is Slurm installed?");
  // "12" or "12;cluster"; what else it says comes first.
  const std::size_t end = result.out.find_last_not_of('\n');
  const std::string last = end == std::string::npos ? "" : result.out.substr(0, end + 1);
  const std::string line = last.substr(last.find_last_of('\n') + 1);
  std::string number = line.substr(0, line.find(';'));
  if (result.code != 0 || !detail::parse_unsigned(number)) {
    throw RunError(RunErrorKind::kUsage, "--on slurm: sbatch rejected the jobs: " + last);
  }
  return number;
}

std::string end_of_task(const SlurmTask& task) {
  const ProgramResult accounting =
      run_program({"sacct", "--noheader", "--parsable2", "--allocations", "--format=State", "--jobs=" + task.id()});
  std::string state = trimmed_line(accounting.out);
  if (accounting.code == 0 && !state.empty() && state.find("disabled") == std::string::npos) return state;
  const ProgramResult controller = run_program({"scontrol", "--oneliner", "show", "job", task.id()});
  if (controller.code != 0) return "UNKNOWN";
  const std::string known = value_after(controller.out, "JobState");
  return known.empty() ? "UNKNOWN" : known;
}

bool is_over(const std::string& state) {
  constexpr std::array kEnds = {"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE", "FAILED", "NODE_FAIL",
                                "OUT_OF_ME", "PREEMPTED", "REVOKED",   "TIMEOUT",  "UNKNOWN"};
  // "CANCELLED by 1000" and the like.
  return std::any_of(kEnds.begin(), kEnds.end(), [&](const char* end) { return state.starts_with(end); });
}

void cancel_tasks(const std::vector<SlurmTask>& tasks) {
  std::set<std::string> arrays;
  for (const SlurmTask& task : tasks) arrays.insert(task.array);
  for (const std::string& array : arrays) run_program({"scancel", array});
}

}  // namespace rilo
