// The command's manual page.
#pragma once

#include <string>

#include "command_tree.hpp"

namespace rilo::cli {

/// roff for man(1), section 1, of the whole command with all its subcommands.
std::string man_page(const TreeCommand& tree, const std::string& version);

}  // namespace rilo::cli
