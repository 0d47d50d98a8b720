#include "bench/pool.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <iostream>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <fmt/format.h>

#include "console/failure.hpp"
#include "console/interrupt.hpp"
#include "results/run_outputs.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

constexpr std::chrono::milliseconds kLookInterval{20};

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// Nothing of the child is worth finishing: signals end it at once.
void become_child(pid_t parent) {
  InterruptGuard::release();
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kUnexpected);
#endif
}

// What the child says goes into its log, the attempts below each other.
void redirect_to(const std::filesystem::path& log, std::size_t attempt) {
  const int opened = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | (attempt == 1 ? O_TRUNC : 0), 0666);
  if (opened < 0) return;
  dup2(opened, STDERR_FILENO);
  ::close(opened);
}

std::string reason_of(int status) {
  if (!WIFSIGNALED(status)) {
    return fmt::format("its process ended with code {} and left no result", WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  return fmt::format("its process was ended by signal {} ({}){}", signal, strsignal(signal),
                     signal == SIGKILL ? "; the memory may be exhausted" : "");
}

// In the child. No exception may get out: it would continue as if it were the parent.
[[noreturn]] void work_and_exit(const BenchJob& job, const CellFolder& folder, BenchRunOptions flags,
                                std::size_t attempt) {
  try {
    flags.quiet = false;
    std::cerr << fmt::format("{}, attempt {} on {}\n", job.name(), attempt, host_name());
    CellRecord record{run_cell(job.sequence, job.configuration, flags), attempt, folder.log_name(job), host_name()};
    if (record.failed()) std::cerr << "failed: " << record.cells.front().error << '\n';
    folder.write(job, record);
    _exit(kSuccess);
  } catch (const IoError& error) {
    std::cerr << "rilo: error: " << error.what() << '\n';
    _exit(kCannotWrite);
  } catch (...) {
    std::cerr << "rilo: error: " << current_failure().message << '\n';
    _exit(kUnexpected);
  }
}

class Pool {
 public:
  Pool(const CellFolder& folder, const BenchRunOptions& flags, const BenchEffort& effort, const BenchEvents& events)
      : folder_(folder), flags_(flags), effort_(effort), events_(events) {}

  ~Pool() {
    for (const Task& task : running_) kill(task.child, SIGKILL);
    for (const Task& task : running_) waitpid(task.child, nullptr, 0);
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void run(const std::vector<BenchJob>& jobs) {
    for (const BenchJob& job : jobs) waiting_.push_back({&job, 1, 0});
    while (InterruptGuard::signal() == 0 && !(waiting_.empty() && running_.empty())) {
      while (running_.size() < std::max<std::size_t>(1, effort_.at_a_time) && !waiting_.empty()) start_next();
      if (!end_one()) std::this_thread::sleep_for(kLookInterval);
    }
  }

 private:
  struct Task {
    const BenchJob* job;
    std::size_t attempt;
    pid_t child;
  };

  void start_next() {
    Task task = waiting_.front();
    waiting_.pop_front();
    if (task.attempt == 1 && events_.started) events_.started(*task.job);
    std::cout.flush();
    const pid_t parent = getpid();
    task.child = fork();
    if (task.child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (task.child == 0) {
      become_child(parent);
      redirect_to(folder_.log(*task.job), task.attempt);
      work_and_exit(*task.job, folder_, flags_, task.attempt);
    }
    running_.push_back(task);
  }

  // False when all still run.
  bool end_one() {
    for (auto task = running_.begin(); task != running_.end(); ++task) {
      int status = 0;
      if (waitpid(task->child, &status, WNOHANG) != task->child) continue;
      const Task ended = *task;
      running_.erase(task);
      // Ctrl-C goes to all; a child may be gone before we notice our own.
      if (!(WIFSIGNALED(status) && InterruptGuard::signal() != 0)) take(ended, status);
      return true;
    }
    return false;
  }

  void take(const Task& task, int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == kCannotWrite) {
      throw RunError(RunErrorKind::kCannotWrite,
                     folder_.file(*task.job).string() + ": cannot be written; is the disk full?");
    }
    auto record = status == 0 ? folder_.read(*task.job) : std::nullopt;
    if (!record) record = failed_record(*task.job, folder_, task.attempt, reason_of(status));
    if (record->failed() && task.attempt <= effort_.retries) {
      waiting_.push_front({task.job, task.attempt + 1, 0});
    } else {
      events_.finished(*task.job, *record);
    }
  }

  const CellFolder& folder_;
  const BenchRunOptions& flags_;
  const BenchEffort& effort_;
  const BenchEvents& events_;
  std::deque<Task> waiting_;
  std::vector<Task> running_;
};

}  // namespace

CellRecord failed_record(const BenchJob& job, const CellFolder& folder, std::size_t attempts, const std::string& error,
                         ExitCode code) {
  BenchCell cell;
  cell.sequence = job.sequence.name;
  cell.configuration = job.configuration.name;
  cell.settings = job.configuration.settings;
  cell.error = error;
  cell.error_code = code;
  CellRecord record{{cell}, attempts, folder.log_name(job), host_name()};
  guard_writing([&] { folder.write(job, record); });
  return record;
}

void run_in_pool(const std::vector<BenchJob>& jobs, const CellFolder& folder, const BenchRunOptions& flags,
                 const BenchEffort& effort, const BenchEvents& events) {
  Pool(folder, flags, effort, events).run(jobs);
}

}  // namespace rilo
