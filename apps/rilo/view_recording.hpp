// A results folder, read back for the viewer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo::cli {

struct RecordedRun {
  std::vector<SweepResult> results;  ///< of the covariance only the diagonal; no translation_evidence
  std::vector<std::size_t> indices;  ///< place of each sweep in the data
  nlohmann::json metrics;            ///< metrics.json
};

/// Reads sweeps.csv, trajectory.tum and metrics.json of a run. The velocity during a sweep is taken from the poses
/// before and after it.
/// @throws IoError when one is missing or malformed, or they do not belong together.
RecordedRun read_recorded_run(const std::filesystem::path& folder);

/// Map files (.ply, .pcd) in the folder; the largest when there are several.
std::optional<std::filesystem::path> recorded_map(const std::filesystem::path& folder);

/// For each point of a map the first of `results` that was near it, or the nearest one.
std::vector<std::uint32_t> first_seen(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<SweepResult>& results);

}  // namespace rilo::cli
