// rilo bench and rilo report in a build without them (RILO_BUILD_BENCH=OFF, the demo's).
#include <CLI/CLI.hpp>

#include "command.hpp"
#include "rilo/session/session.hpp"

namespace rilo::cli {

namespace {

void add_absent(CLI::App& app, const std::string& name, const std::string& help) {
  CLI::App* command = app.add_subcommand(name, help + " (not in this build)");
  command->allow_extras();
  command->callback([name] {
    throw RunError(RunErrorKind::kUsage,
                   "this build has no `rilo " + name +
                       "`. Run: cmake --preset command && cmake --build --preset command --parallel");
  });
}

}  // namespace

void add_bench_command(CLI::App& app, const std::string& /*command_line*/, int& /*exit_code*/) {
  add_absent(app, "bench", "several configurations on several sequences");
}

void add_report_command(CLI::App& app, int& /*exit_code*/) {
  add_absent(app, "report", "one page that compares runs and experiments");
}

}  // namespace rilo::cli
