// The loop of a run: sweeps in, results out.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "live_view.hpp"
#include "partial_poses.hpp"
#include "rilo/io/scan_source.hpp"
#include "run_flags.hpp"
#include "run_record.hpp"

namespace rilo::cli {

/// How many sweeps --start and --count leave, when that is known.
std::optional<std::size_t> sweeps_to_do(const RunFlags& flags, const ScanSource& source);

/// Runs the odometry over `source`, opened from flags.data, until the data, --count, a signal or an error ends it, and
/// fills what is known then into `run`. An error keeps what was done before it: it stands in run.error. When the
/// sensor's elevation error becomes certain early, the run starts over with it (run.started_over_after) unless
/// flags.one_pass: what a robot cannot do, a recording allows. `view`: is shown every sweep, or null.
void run_sweeps(const RunFlags& flags, std::unique_ptr<ScanSource> source, PartialPoses& partial, RunRecord& run,
                LiveView* view);

}  // namespace rilo::cli
