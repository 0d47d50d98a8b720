#include "usage_error.hpp"

#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "config/nearest_word.hpp"

namespace rilo::cli {

namespace {

std::string suggestion(const std::string& word) { return word.empty() ? "" : "; did you mean " + word + "?"; }

std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

// The first option that `command` does not have, or the first word that it has no place for.
std::string unexpected(const CLI::App& command, const std::vector<std::string>& left) {
  for (const std::string& word : left) {
    if (!word.starts_with("-") || word.find_first_not_of('-') == std::string::npos) continue;
    const std::string name = word.substr(0, word.find('='));
    const std::string meant =
        nearest_word(std::string_view(name).substr(name.find_first_not_of('-')), options_of(command));
    if ("--" + meant == name) return "option " + name + " after --, behind which all are arguments";
    return "unknown option " + name + suggestion(meant.empty() ? "" : "--" + meant);
  }
  return left.empty() ? "" : "unexpected argument \"" + left.front() + "\"";
}

// A value that is optional has to be joined to its option.
std::string detached_port(int argc, const char* const* argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    const std::string_view port = argv[i + 1];
    const bool number = !port.empty() && port.find_first_not_of("0123456789") == std::string_view::npos;
    if (std::string_view(argv[i]) == "--view" && number) return "; the port is given as --view=" + std::string(port);
  }
  return "";
}

// In the order of the command line: CLI11 keeps them the other way round.
std::vector<std::string> left_over(const CLI::App& app, int argc, const char* const* argv) {
  const std::vector<std::string> remaining = app.remaining(true);
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    for (const std::string& word : remaining) {
      if (word != argv[i]) continue;
      words.push_back(word);
      break;
    }
  }
  return words;
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  const CLI::App* command = &app;
  std::string name = "rilo";
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += " " + command->get_name();
  }
  std::string text = error.what();
  const bool extras = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (command == &app && argc > 1 && !std::string_view(argv[1]).starts_with("-")) {
    const std::string meant = nearest_word(argv[1], subcommands_of(app));
    text = "unknown subcommand \"" + std::string(argv[1]) + "\"" + suggestion(meant.empty() ? "" : "rilo " + meant);
  } else if (extras) {
    const std::string found = unexpected(*command, left_over(app, argc, argv));
    if (!found.empty()) text = found + detached_port(argc, argv);
  }
  // Of an option at the end of the line; CLI11 says "1 required TEXT missing".
  if (const auto count = text.find(": 1 required "); count != std::string::npos) {
    text = text.substr(0, count) + ": its value is missing";
  }
  return text + (text.ends_with("?") ? " See: " : ". See: ") + name + " --help";
}

}  // namespace rilo::cli
