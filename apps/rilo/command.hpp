// What all subcommands share.
#pragma once

#include <stdexcept>
#include <string>

#include "cli11_app.hpp"

namespace rilo::cli {

/// Exit codes; `rilo --help` and docs/command.md list them.
enum ExitCode : int {
  kSuccess = 0,
  kUnexpected = 1,    ///< a bug or an exhausted machine
  kUsage = 2,         ///< command line or configuration
  kBadData = 3,       ///< data missing, malformed or of no known format
  kCannotWrite = 4,   ///< results could not be written
  kSignalBase = 128,  ///< + the signal's number: 130 SIGINT, 143 SIGTERM; what was done is written
};

/// An error whose exit code is known. Everything else is mapped in main.cpp.
class CommandError : public std::runtime_error {
 public:
  CommandError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// Each subcommand adds itself to `app`; when it is chosen, its callback runs it and sets `exit_code`. Errors are
// exceptions. `command_line` goes into the results.
void add_run_command(CLI::App& app, const std::string& command_line, int& exit_code);
void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_code);
void add_eval_command(CLI::App& app, int& exit_code);
void add_quality_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_simulate_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);

}  // namespace rilo::cli
