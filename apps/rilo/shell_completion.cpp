// Completion of the command line for bash, zsh and fish.
#include <fmt/format.h>

#include "command_tree.hpp"
#include "console/text.hpp"

namespace rilo::cli {

namespace {

std::string in_a_row(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::vector<std::string> names_of(const std::vector<TreeCommand>& commands) {
  std::vector<std::string> names;
  for (const TreeCommand& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> option_names(const TreeCommand& command) {
  std::vector<std::string> names;
  for (const TreeOption& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// Within single quotes of fish, where the backslash counts.
std::string fish_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return result + "'";
}

/// Help and messages of zsh's _arguments end at brackets and colons.
std::string zsh_plain(const std::string& text) {
  std::string result;
  for (const char c : text) result += (c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + std::string(1, c);
  return result;
}

std::string zsh_option(const TreeOption& option) {
  std::string lines;
  for (const std::string& name : option.names) {
    std::string spec = (option.repeatable ? "*" : "") + name + "[" + zsh_plain(option.help) + "]";
    if (!option.value.empty()) {
      spec += ":" + zsh_plain(option.value) + ":" +
              (option.choices.empty() ? "_files" : "(" + in_a_row(option.choices) + ")");
    }
    lines += " \\\n        " + shell_quoted(spec);
  }
  return lines;
}

}  // namespace

std::string bash_completion(const TreeCommand& tree) {
  std::string below;
  std::string options;
  std::string choices;
  for (const TreeCommand* command : flattened(tree)) {
    below += fmt::format("    {}) commands={} ;;\n", shell_quoted(command->path),
                         shell_quoted(in_a_row(names_of(command->commands))));
    options += fmt::format("    {}) options={} ;;\n", shell_quoted(command->path),
                           shell_quoted(in_a_row(option_names(*command))));
    for (const TreeOption& option : command->options) {
      for (const std::string& name : option.names) {
        if (option.choices.empty()) continue;
        choices += fmt::format("    {}) COMPREPLY=($(compgen -W {} -- \"$word\")); return ;;\n",
                               shell_quoted(command->path + " " + name), shell_quoted(in_a_row(option.choices)));
      }
    }
  }
  return "# Completion of rilo for bash; written by: rilo completion bash\n"
         "_rilo() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} path=rilo commands options i\n"
         "  for ((i = 1; i <= COMP_CWORD; i++)); do\n"
         "    case $path in\n" +
         below +
         "    esac\n"
         "    ((i < COMP_CWORD)) || break\n"
         "    [[ \" $commands \" == *\" ${COMP_WORDS[i]} \"* ]] && path+=\" ${COMP_WORDS[i]}\"\n"
         "  done\n"
         "  case \"$path $before\" in\n" +
         choices +
         "  esac\n"
         "  case $path in\n" +
         options +
         "  esac\n"
         "  if [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -W \"$commands\" -- \"$word\"))\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _rilo rilo\n";
}

std::string zsh_completion(const TreeCommand& tree) {
  std::string cases;
  for (const TreeCommand* command : flattened(tree)) {
    std::string specs;
    for (const TreeOption& option : command->options) specs += zsh_option(option);
    if (!command->commands.empty())
      specs += " \\\n        " + shell_quoted("*: :(" + in_a_row(names_of(command->commands)) + ")");
    else
      specs += " \\\n        '*:file:_files'";
    cases += fmt::format("    {})\n      _arguments -S{} ;;\n", shell_quoted(command->path), specs);
  }
  std::vector<std::string> known;
  for (const TreeCommand* command : flattened(tree)) {
    if (command != &tree) known.push_back(shell_quoted(command->path));
  }
  return "#compdef rilo\n# Completion of rilo for zsh; written by: rilo completion zsh\n"
         "_rilo() {\n"
         "  local path_=rilo i\n"
         "  for ((i = 2; i < CURRENT; i++)); do\n"
         "    case \"$path_ ${words[i]}\" in\n      " +
         fmt::format("{}", fmt::join(known, "|")) +
         ") path_=\"$path_ ${words[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case $path_ in\n" +
         cases + "  esac\n}\n_rilo \"$@\"\n";
}

std::string fish_completion(const TreeCommand& tree) {
  std::string text = "# Completion of rilo for fish; written by: rilo completion fish\n";
  const std::string all = in_a_row(names_of(tree.commands));
  for (const TreeCommand& command : tree.commands) {
    text += fmt::format("complete -c rilo -n 'not __fish_seen_subcommand_from {}' -f -a {} -d {}\n", all, command.name,
                        fish_quoted(command.help));
    const std::string names = in_a_row(names_of(command.commands));
    for (const TreeCommand& below : command.commands) {
      text += fmt::format(
          "complete -c rilo -n '__fish_seen_subcommand_from {}; and not __fish_seen_subcommand_from {}' -f -a {} -d "
          "{}\n",
          command.name, names, below.name, fish_quoted(below.help));
    }
    for (const TreeCommand* within : flattened(command)) {
      for (const TreeOption& option : within->options) {
        text += fmt::format("complete -c rilo -n '__fish_seen_subcommand_from {}'", command.name);
        for (const std::string& name : option.names) {
          text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
        if (!option.value.empty())
          text += option.choices.empty() ? " -r" : " -x -a " + fish_quoted(in_a_row(option.choices));
        text += " -d " + fish_quoted(option.help) + "\n";
      }
    }
  }
  return text;
}

}  // namespace rilo::cli
