// rilo config: prints and checks configurations.
#include <iostream>

#include <CLI/CLI.hpp>

#include "checks.hpp"
#include "command.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo::cli {

namespace {

struct ConfigFlags {
  std::string file;
  std::vector<std::string> settings;
  std::string check;
  bool dump = false;
  bool markdown = false;
};

constexpr const char* kConfigFooter = R"(Examples:
  rilo config --dump > my.yaml                            all keys with unit, range and meaning
  rilo config --dump --config my.yaml --set map.levels=3  what a run with these would use
  rilo config --check my.yaml)";

int config(const ConfigFlags& flags) {
  if (!flags.check.empty()) {
    load_config(flags.check);
    std::cout << flags.check << ": ok\n";
    return kSuccess;
  }
  const OdometryConfig merged = load_config(flags.file, flags.settings);
  std::cout << (flags.markdown ? config_markdown(merged) : dump_config(merged));
  return kSuccess;
}

}  // namespace

void add_config_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<ConfigFlags>();
  CLI::App* command = app.add_subcommand("config", "print or check a configuration");
  command->footer(kConfigFooter);
  auto* dump = command->add_flag("--dump", flags->dump, "print the configuration as YAML");
  auto* check =
      command->add_option("--check", flags->check, "check a file and report what is wrong")->check(path_given());
  dump->excludes(check);
  command->add_option("--config", flags->file, "start from this file")->check(path_given())->excludes(check);
  command->add_option("--set", flags->settings, "key=value, repeatable")->allow_extra_args(false)->excludes(check);
  command->add_flag("--markdown", flags->markdown, "with --dump: the keys for users as a table")->needs(dump);
  command->callback([flags, &exit_code] {
    if (!flags->dump && flags->check.empty()) {
      throw RunError(RunErrorKind::kUsage, "config: give --dump or --check FILE");
    }
    exit_code = config(*flags);
  });
}

}  // namespace rilo::cli
