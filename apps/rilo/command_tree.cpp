#include "command_tree.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace rilo::cli {

namespace {

/// "TEXT:{auto,none}" names the words between the braces.
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return choices;
  std::size_t from = open + 1;
  for (std::size_t comma = type.find(',', from); from <= close; comma = type.find(',', from)) {
    const std::size_t end = std::min(comma, close);
    choices.push_back(type.substr(from, end - from));
    from = end + 1;
  }
  return choices;
}

TreeOption option_of(const CLI::Option& option) {
  TreeOption result;
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  if (option.get_positional()) result.names = {option.get_name(true)};
  const std::string type = option.get_type_name();
  result.value = option.get_items_expected_max() == 0 ? "" : type.substr(0, type.find(':'));
  result.choices = choices_of(type);
  result.help = option.get_description();
  result.fallback = option.get_default_str();
  result.required = option.get_required();
  result.repeatable = option.get_expected_max() > 1;
  return result;
}

TreeCommand tree_of(const CLI::App& app, const std::string& above) {
  TreeCommand command;
  command.name = app.get_name();
  command.path = above + (above.empty() ? "" : " ") + command.name;
  command.help = app.get_description();
  command.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? command.positionals : command.options).push_back(option_of(*option));
  }
  for (const CLI::App* below : app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); })) {
    command.commands.push_back(tree_of(*below, command.path));
  }
  return command;
}

void add_flattened(const TreeCommand& tree, std::vector<const TreeCommand*>& all) {
  all.push_back(&tree);
  for (const TreeCommand& below : tree.commands) add_flattened(below, all);
}

}  // namespace

TreeCommand command_tree(const CLI::App& app) { return tree_of(app, ""); }

std::vector<const TreeCommand*> flattened(const TreeCommand& tree) {
  std::vector<const TreeCommand*> all;
  add_flattened(tree, all);
  return all;
}

}  // namespace rilo::cli
