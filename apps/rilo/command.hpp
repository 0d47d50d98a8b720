// What all subcommands share.
#pragma once

#include <string>

#include "cli11_app.hpp"
#include "console/failure.hpp"

namespace rilo::cli {

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
/// rilo man and rilo completion, which describe `app` with all that it has when they are run.
void add_describe_commands(CLI::App& app, int& exit_code);

}  // namespace rilo::cli
