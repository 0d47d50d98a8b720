// Everything a run leaves behind, before it is written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

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
  std::vector<std::string> warnings;
};

struct RunRecord {
  std::string command_line;
  std::filesystem::path data;
  SourceInfo source;
  OdometryConfig config;
  int threads = 0;
  std::vector<SweepResult> results;
  std::vector<std::size_t> indices;  ///< place of each sweep in the data
  PoseInstant pose_instant = PoseInstant::kMid;
  std::vector<Eigen::Vector3f> map;  ///< thinned points of all registered sweeps, odometry frame
  double wall_s = 0;
  int signal = 0;     ///< that ended the run early, 0: none
  std::string error;  ///< that ended the run early
  std::optional<TruthMatch> truth;
  std::optional<Evaluation> evaluation;
};

/// metrics.json.
nlohmann::json run_metrics(const RunRecord& run);

/// The few lines that a person reads at the end.
std::string run_summary(const nlohmann::json& metrics);

/// Looks for ground truth beside the data and evaluates; a truth file that cannot be read becomes a warning of the
/// source, since the run itself is good.
void evaluate_run(RunRecord& run);

/// Throws CommandError(kCannotWrite) unless results can be written into `folder`, which is created.
void prepare_output(const std::filesystem::path& folder);

/// Writes all result files into `folder`, each whole or not at all.
void write_outputs(const RunRecord& run, const nlohmann::json& metrics, const std::filesystem::path& folder,
                   bool with_report);

}  // namespace rilo::cli
