#include "results/run_truth.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "console/text.hpp"
#include "io/folders/ground_truth.hpp"
#include "io/stamp_difference.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

PosesOfSweeps by_stamp(const PoseFile& file, const RunRecord& run, double max_gap_s) {
  const Trajectory sweeps = run.trajectory();
  PosesOfSweeps poses(sweeps.size());
  try {
    const auto matched = match_by_stamp(file.trajectory, sweeps, detail::nanoseconds(max_gap_s));
    for (std::size_t i = 0; i < matched.truth.size(); ++i) poses[matched.estimate_index[i]] = matched.truth[i];
  } catch (const std::invalid_argument& error) {
    throw RunError(RunErrorKind::kBadData, file.file.string() + ": " + error.what());
  }
  return poses;
}

/// Each part of a sweep has a pose; that of the sweep lies at its beginning, middle or end.
std::optional<SE3> of_joined(const std::vector<SE3>& poses, std::size_t known, std::size_t first,
                             const RunRecord& run) {
  const std::size_t last = run.source.parts - 1;
  std::size_t halves = last;  // of a part, from the first to the one where the pose lies
  if (run.pose_instant == PoseInstant::kStart) halves = 0;
  if (run.pose_instant == PoseInstant::kEnd) halves = 2 * last;
  const std::size_t before = first + halves / 2;
  const std::size_t after = first + (halves + 1) / 2;
  if (after >= known) return std::nullopt;
  return before == after ? poses[before] : interpolate(poses[before], poses[after], 0.5);
}

PosesOfSweeps by_index(const std::vector<SE3>& poses, const RunRecord& run) {
  const std::size_t known = std::min(poses.size(), run.source.places_known.value_or(poses.size()));
  PosesOfSweeps result;
  for (const std::size_t index : run.indices) result.push_back(of_joined(poses, known, index, run));
  return result;
}

PosesOfSweeps estimate_of(const RunRecord& run) {
  PosesOfSweeps poses;
  for (const SweepResult& result : run.results) poses.emplace_back(result.T_odom_lidar);
  return poses;
}

}  // namespace

void to_lidar_frame(PoseFile& file, const std::optional<SE3>& T_cam_lidar) {
  if (!T_cam_lidar) {
    throw RunError(RunErrorKind::kBadData, file.file.string() +
                                               ": poses in the camera frame, and no calib.txt with Tr in a folder of "
                                               "their data; expected the transform from LiDAR to camera there (rilo "
                                               "report: in the folder of the run's data, or in the one after --gt)");
  }
  const std::vector<SE3> poses = camera_to_lidar(poses_of(file.trajectory), *T_cam_lidar);
  for (std::size_t i = 0; i < poses.size(); ++i) file.trajectory[i].T_odom_lidar = poses[i];
}

PosesOfSweeps poses_of_sweeps(const GivenPoses& given, const RunRecord& run) {
  PoseFile file = read_poses(given.file);
  if (given.camera_frame) to_lidar_frame(file, run.source.T_cam_lidar);
  return file.stamped ? by_stamp(file, run, given.max_gap_s) : by_index(poses_of(file.trajectory), run);
}

std::optional<SweepTruth> truth_of_sweeps(const RunRecord& run, const std::optional<GivenPoses>& given) {
  if (given) return SweepTruth{poses_of_sweeps(*given, run), given->file.string(), "as in the given file", {}};
  const auto truth = read_ground_truth(run.data, run.pose_instant);
  if (!truth) return std::nullopt;
  return SweepTruth{by_index(truth->T_world_lidar, run), truth->file.string(), truth->instant, truth->warnings};
}

TruthMatch match_truth(const SweepTruth& truth, const PosesOfSweeps& estimate) {
  TruthMatch match;
  match.file = truth.file;
  match.instant = truth.instant;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!truth.poses[i] || !estimate[i]) continue;
    match.truth.push_back(*truth.poses[i]);
    match.estimate.push_back(*estimate[i]);
    match.matched.push_back(i);
  }
  if (match.truth.size() < 2) {
    throw RunError(RunErrorKind::kBadData,
                   truth.file + ": fewer than two of the sweeps that were run have a true pose");
  }
  return match;
}

void evaluate_run(RunRecord& run, const std::optional<GivenPoses>& given) {
  const auto truth = truth_of_sweeps(run, given);
  if (!truth) return;
  run.source.warnings.insert(run.source.warnings.end(), truth->warnings.begin(), truth->warnings.end());
  TruthMatch matched = match_truth(*truth, estimate_of(run));
  run.evaluation = evaluate(matched.truth, matched.estimate);
  run.truth = std::move(matched);
}

void evaluate_run(RunRecord& run) {
  try {
    evaluate_run(run, std::nullopt);
  } catch (const std::runtime_error& error) {  // IoError, RunError
    run.truth_error = error.what();
  } catch (const std::invalid_argument& error) {
    run.truth_error = error.what();
  }
  if (!run.truth_error.empty()) run.source.warnings.push_back("ground truth not used: " + run.truth_error);
}

}  // namespace rilo
