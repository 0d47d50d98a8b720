// The installed command as a process: arguments in, both streams and the exit status out.
#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "io/io_test_util.hpp"

namespace rilo::test {

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;      ///< that ended it, 0: none
  std::string out;
  std::string err;
};

/// The command of the environment variable RILO_BIN, running. One that outlives its time is killed, which fails the
/// test: nothing hangs.
class CommandProcess {
 public:
  explicit CommandProcess(const std::vector<std::string>& arguments);
  ~CommandProcess();
  CommandProcess(const CommandProcess&) = delete;
  CommandProcess& operator=(const CommandProcess&) = delete;

  void send(int signal) const;
  pid_t pid() const { return pid_; }
  /// Waits until `condition` holds; false when the process ended or the time is over before.
  bool wait_until(const std::function<bool()>& condition);
  Outcome wait();

 private:
  bool ended();

  TempDir streams_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool reaped_ = false;
  std::chrono::steady_clock::time_point deadline_;
};

/// Runs the command to its end.
Outcome rilo_command(const std::vector<std::string>& arguments);

/// Runs the command, which must succeed.
Outcome rilo_succeeds(const std::vector<std::string>& arguments);

/// Runs the command, which must end with that code, with exactly one line
/// `rilo: error: …` that has all `parts`.
Outcome rilo_fails(int exit_code, const std::vector<std::string>& arguments, const std::vector<std::string>& parts);

/// All `parts` occur in `text`.
void expect_parts(const std::string& text, const std::vector<std::string>& parts);

/// The processes that a process has started and that still run.
std::set<pid_t> children_of(pid_t parent);

/// Lines of `text` that begin with `start`.
std::vector<std::string> lines_with(const std::string& text, std::string_view start);
std::vector<std::string> lines_of(const std::string& text);

}  // namespace rilo::test
