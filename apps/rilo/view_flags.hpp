// Command-line options of the viewer, shared by run and view.
#pragma once

#include <string>

#include "cli11_app.hpp"
#include "view/viewer.hpp"

namespace rilo::cli {

/// What the rest of the options of a viewer are called, `--view-address` or `--address`.
void add_address_flag(CLI::App& command, const std::string& name, ViewOptions& options);

}  // namespace rilo::cli
