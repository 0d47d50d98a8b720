// What is wrong with a command line, in words that help.
#pragma once

#include <string>

#include "cli11_app.hpp"

namespace CLI {
class ParseError;
}

namespace rilo::cli {

/// One line: the unknown word, the nearest known one, and where the help is.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv);

}  // namespace rilo::cli
