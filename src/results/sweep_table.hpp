// sweeps.csv: the statistics of every sweep of a run, written and read by one table of columns.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

struct SweepTable {
  std::vector<SweepResult> results;
  std::vector<std::size_t> indices;  ///< place of each sweep in the data
};

/// A header line, then one line per sweep: its place in the data, stamp and status, every field of SweepStats, speed
/// and turn rate, standard deviations of the pose in the sensor's axes. Numbers are written without loss. Both
/// arguments have the same length.
std::string sweeps_csv(const std::vector<SweepResult>& results, const std::vector<std::size_t>& indices);

/// Reads it back, lines ending in LF or CRLF. Columns are found by their names; those that no report can do without
/// must be there, the others keep their defaults. Poses and velocities are not in this file; of the covariance the
/// diagonal is. @throws IoError with line and column.
SweepTable read_sweeps_csv(const std::filesystem::path& file);

}  // namespace rilo
