// Statistics of every sweep as a table.
#pragma once

#include <string>

#include "run_record.hpp"

namespace rilo::cli {

/// A header line, then a line a sweep: its place in the data, stamp and status, every field of SweepStats, speed and
/// turn rate, standard deviations of the pose in the sensor's axes. Numbers are written without loss.
std::string sweeps_csv(const RunRecord& run);

}  // namespace rilo::cli
