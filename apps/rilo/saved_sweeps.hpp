// sweeps.csv of a finished run, read back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo::cli {

struct SavedSweeps {
  std::vector<SweepResult> results;  ///< stamps, status and what a report shows; poses are not in this file
  std::vector<std::size_t> indices;  ///< place of each sweep in the data
};

/// Columns are found by their names; those that are not needed may be missing.
/// @throws IoError with line and column.
SavedSweeps read_sweeps_csv(const std::filesystem::path& file);

}  // namespace rilo::cli
