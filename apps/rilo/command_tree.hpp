// What the command understands, as data: for the man page and for completion.
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

}  // namespace rilo::cli
