// The rilo command: parses, dispatches, and maps every error to one line and an exit code.
#include <csignal>
#include <iostream>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "console/failure.hpp"
#include "console/text.hpp"
#include "console/version.hpp"
#include "usage_error.hpp"

namespace {

constexpr const char* kFooter = R"(Examples:
  rilo simulate --out drive --sensor hdl64 --sweeps 200     simulate a test drive
  rilo run drive --out results --map results/map.ply        odometry, map, figures, report.html
  rilo eval drive results/poses_lidar.txt                   errors against ground truth
  rilo quality drive results/poses_lidar.txt                how sharp the map is; needs no ground truth
  rilo run drive --view                                     watch it in a browser while it runs
  rilo view results                                         replay it
  rilo bench experiments/ablation.yaml --data drive         several configurations on several drives
  rilo report results other-results                         one page that compares runs
  rilo config --dump > my.yaml                              every key with its unit and meaning

Exit codes: 0 success, 1 unexpected error, 2 wrong usage or configuration, 3 data missing or malformed,
4 results could not be written, 130 interrupted by Ctrl-C, 143 terminated, 129 terminal closed (what was done is
written).)";

int fail(int code, const std::string& message) {
  std::cerr << "rilo: error: " << rilo::printable(message) << '\n';
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace rilo;
  int exit_code = kSuccess;
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is an error with a message, as a full disk
  CLI::App app{"Rilo: LiDAR-only odometry with a reliable initial pose", "rilo"};
  app.set_version_flag("--version", std::string("rilo ") + kVersion);
  app.require_subcommand(1);
  app.footer(kFooter);
  cli::add_run_command(app, command_line(argc, argv), exit_code);
  cli::add_eval_command(app, exit_code);
  cli::add_bench_command(app, command_line(argc, argv), exit_code);
  cli::add_view_command(app, exit_code);
  cli::add_quality_command(app, exit_code);
  cli::add_report_command(app, exit_code);
  cli::add_simulate_command(app, exit_code);
  cli::add_config_command(app, exit_code);
  cli::add_info_command(app, exit_code);
  cli::add_describe_commands(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return fail(kUsage, cli::usage_error(app, error, argc, argv));
    exit_code = app.exit(error);  // --help, --version
  } catch (...) {
    const Failure failure = current_failure();
    return fail(failure.code, failure.message);
  }
  std::cout.flush();
  return std::cout ? exit_code : fail(kCannotWrite, "standard output: cannot be written");
}
