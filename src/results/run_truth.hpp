// True poses for the sweeps of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/pose_files.hpp"
#include "results/run_record.hpp"

namespace rilo {

/// A pose file that the user named, KITTI or TUM form.
struct GivenPoses {
  std::filesystem::path file;
  bool camera_frame = false;  ///< else LiDAR frame
  double max_gap_s = 0.02;    ///< by stamp: largest distance to the sweep's pose
};

/// A pose for each sweep of the run that has one.
using PosesOfSweeps = std::vector<std::optional<SE3>>;

struct SweepTruth {
  PosesOfSweeps poses;
  std::string file;
  std::string instant;  ///< what they refer to
  std::vector<std::string> warnings;
};

/// Poses of the camera become those of the LiDAR. @throws RunError without the transform.
void to_lidar_frame(PoseFile& file, const std::optional<SE3>& T_cam_lidar);

/// Poses with stamps belong to the sweep whose pose is nearest in time, others to the sweep of their place in the data.
/// @throws IoError, RunError when none fits or the frame cannot be changed.
PosesOfSweeps poses_of_sweeps(const GivenPoses& given, const RunRecord& run);

/// Of the given file, or what lies beside the data. @throws as poses_of_sweeps.
std::optional<SweepTruth> truth_of_sweeps(const RunRecord& run, const std::optional<GivenPoses>& given);

/// The sweeps that have both poses. @throws RunError when those are fewer than two.
TruthMatch match_truth(const SweepTruth& truth, const PosesOfSweeps& estimate);

/// As evaluate_run(run), with ground truth from the given file. Errors are exceptions.
void evaluate_run(RunRecord& run, const std::optional<GivenPoses>& given);

}  // namespace rilo
