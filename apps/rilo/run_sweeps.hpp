// The loop of a run: sweeps in, results out.
#pragma once

#include "partial_poses.hpp"
#include "rilo/io/scan_source.hpp"
#include "run_flags.hpp"
#include "run_record.hpp"

namespace rilo::cli {

/// Runs the odometry over `source` until the data, --count, a signal or an error ends it, and fills what is known then
/// into `run`. An error keeps what was done before it: it stands in run.error.
void run_sweeps(const RunFlags& flags, ScanSource& source, PartialPoses& partial, RunRecord& run);

}  // namespace rilo::cli
