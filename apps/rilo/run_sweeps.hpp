// The loop of a run: sweeps in, results out.
#pragma once

#include <cstddef>
#include <optional>

#include "live_view.hpp"
#include "partial_poses.hpp"
#include "rilo/io/scan_source.hpp"
#include "run_flags.hpp"
#include "run_record.hpp"

namespace rilo::cli {

/// How many sweeps --start and --count leave, when that is known.
std::optional<std::size_t> sweeps_to_do(const RunFlags& flags, const ScanSource& source);

/// Runs the odometry over `source` until the data, --count, a signal or an error ends it, and fills what is known then
/// into `run`. An error keeps what was done before it: it stands in run.error. `view`: is shown every sweep, or null.
void run_sweeps(const RunFlags& flags, ScanSource& source, PartialPoses& partial, RunRecord& run,
                LiveView* view = nullptr);

}  // namespace rilo::cli
