// Command-line options on how data are read; shared by run, quality and info.
#pragma once

#include "cli11_app.hpp"
#include "results/run_request.hpp"

namespace rilo::cli {

/// Adds --bin-fields, --point-times and the others to `command`; they end up in `request`.
void add_source_flags(CLI::App& command, SourceRequest& request);

}  // namespace rilo::cli
