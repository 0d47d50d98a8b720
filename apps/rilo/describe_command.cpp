// rilo man, rilo completion.
#include <iostream>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "command_tree.hpp"
#include "console/version.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kManFooter = R"(Example:
  rilo man | man -l -)";

constexpr const char* kCompletionFooter = R"(Packages and cmake --install put these where the shells look. By hand:
  rilo completion bash > ~/.local/share/bash-completion/completions/rilo
  rilo completion zsh > ~/.zsh/completions/_rilo     in a folder of $fpath
  rilo completion fish > ~/.config/fish/completions/rilo.fish)";

}  // namespace

void add_describe_commands(CLI::App& app, int& exit_code) {
  CLI::App* man = app.add_subcommand("man", "print the manual page");
  man->footer(kManFooter);
  man->callback([&app, &exit_code] {
    std::cout << man_page(command_tree(app), kVersion);
    exit_code = kSuccess;
  });
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand("completion", "print what a shell needs to complete rilo's command line");
  completion->footer(kCompletionFooter);
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([&app, shell, &exit_code] {
    using Writer = std::string (*)(const TreeCommand&);
    static const std::map<std::string, Writer> kWriters = {
        {"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}};
    std::cout << kWriters.at(*shell)(command_tree(app));
    exit_code = kSuccess;
  });
}

}  // namespace rilo::cli
