// What the command understands, as data; the man page and the completion of shells that are made of it.
#pragma once

#include <string>
#include <vector>

#include "cli11_app.hpp"

namespace rilo::cli {

struct TreeOption {
  std::vector<std::string> names;    ///< "-o", "--out"; of a positional its one name
  std::string value;                 ///< what the value is called; empty: a flag
  std::vector<std::string> choices;  ///< the only values there are; empty: any
  std::string help;
  std::string fallback;  ///< default as printed; empty: none
  bool required = false;
  bool repeatable = false;
};

struct TreeCommand {
  std::string name;  ///< "run"
  std::string path;  ///< "rilo run"
  std::string help;
  std::string footer;
  std::vector<TreeOption> positionals;
  std::vector<TreeOption> options;
  std::vector<TreeCommand> commands;
};

/// Everything below `app`, in the order in which it was added.
TreeCommand command_tree(const CLI::App& app);

/// The command and all below it, each before its own.
std::vector<const TreeCommand*> flattened(const TreeCommand& tree);

/// roff for man(1), section 1, of the whole command with all its subcommands.
std::string man_page(const TreeCommand& tree, const std::string& version);

/// Scripts that complete subcommands, options and the words of options that have few; files elsewhere.
std::string bash_completion(const TreeCommand& tree);
std::string zsh_completion(const TreeCommand& tree);
std::string fish_completion(const TreeCommand& tree);

}  // namespace rilo::cli
