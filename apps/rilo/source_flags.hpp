// Command-line options that say how data are read; shared by run, quality and info.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli11_app.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo::cli {

struct SourceFlags {
  SourceOptions options;
  bool times_needed = false;  ///< --point-times data
};

/// Adds --bin-fields, --point-times and the others to `command`; they end up in `flags`.
void add_source_flags(CLI::App& command, SourceFlags& flags);

/// What metrics.json and `rilo info --json` say about the stamps.
nlohmann::json stamp_faults_json(const StampFaults& faults);

/// @throws CommandError(kBadData) when the sweep of that name lacks the point times that are needed.
void check_point_times(const SourceFlags& flags, const Sweep& sweep, const std::string& name);

}  // namespace rilo::cli
