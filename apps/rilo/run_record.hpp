// Everything a run leaves behind, before it is written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "rilo/cloud/map_cloud.hpp"
#include "rilo/evaluation/evaluation.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo::cli {

/// Ground truth of the sweeps that were run, in the LiDAR frame.
struct TruthMatch {
  std::vector<SE3> truth;     ///< of the sweeps that have one
  std::vector<SE3> estimate;  ///< the poses of the same sweeps
  std::string file;
  std::string instant;  ///< what the true poses refer to
};

struct RunRecord {
  std::string command_line;
  std::filesystem::path data;
  SourceInfo source;
  OdometryConfig config;  ///< that led to `results`: with the elevation error, when the run started over
  int threads = 0;
  std::optional<std::size_t> started_over_after;  ///< sweeps, when the sensor's elevation error had become certain
  std::vector<SweepResult> results;
  std::vector<std::size_t> indices;  ///< place of each sweep in the data
  PoseInstant pose_instant = PoseInstant::kMid;
  MapCloud map;  ///< thinned points of all registered sweeps
  double wall_s = 0;
  double peak_rss_mb = 0;          ///< up to the last sweep
  int signal = 0;                  ///< that ended the run early, 0: none
  std::string error;               ///< that ended the run early, empty: none
  ExitCode error_code = kSuccess;  ///< of that error
  std::optional<TruthMatch> truth;
  std::string truth_error;  ///< why ground truth that lies there could not be used
  std::optional<Evaluation> evaluation;
};

/// Looks for ground truth beside the data and evaluates. Truth that cannot be read is said in truth_error and does not
/// spoil the run.
void evaluate_run(RunRecord& run);

/// metrics.json.
nlohmann::json run_metrics(const RunRecord& run);

/// The few lines that a person reads at the end.
std::string run_summary(const nlohmann::json& metrics);

}  // namespace rilo::cli
