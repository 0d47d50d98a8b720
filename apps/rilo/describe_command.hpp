// rilo man, rilo completion.
#pragma once

#include "cli11_app.hpp"

namespace rilo::cli {

/// Adds both to `app`, which they describe with all that it has when they are run.
void add_describe_commands(CLI::App& app, int& exit_code);

}  // namespace rilo::cli
