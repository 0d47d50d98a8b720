// Completion of the command line for shells.
#pragma once

#include <string>

#include "command_tree.hpp"

namespace rilo::cli {

/// Scripts that complete subcommands, options and the words of options that have few; files elsewhere.
std::string bash_completion(const TreeCommand& tree);
std::string zsh_completion(const TreeCommand& tree);
std::string fish_completion(const TreeCommand& tree);

}  // namespace rilo::cli
