// Errors of the poses of a trajectory against the true one: absolute, relative, and along the way.
#pragma once

#include <cstddef>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Statistics in the unit of the errors. rmse² = mean² + std² (population standard deviation, as evo and numpy do).
/// All zero when there is no error (count = 0).
struct ErrorSummary {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double std = 0;
  double median = 0;  ///< mean of the two middle values when count is even
  double max = 0;
};

/// Statistics of `errors` (finite, any order).
ErrorSummary summarise(std::vector<double> errors);

/// What is done to the estimate before absolute errors are taken.
enum class Alignment {
  kNone,       ///< nothing: both trajectories are compared as given
  kFirstPose,  ///< the first poses are made equal: errors grow with the drift
  kUmeyama,    ///< least-squares rigid motion, no scale: what papers call APE or ATE
};

/// Rigid motion T_truth_estimate that minimises the squared distances between the positions of `truth` and the moved
/// positions of `estimate` (Umeyama, PAMI 1991, without scale). Where positions leave a rotation open (a straight line,
/// a sensor at rest), the orientations of the poses decide it.
/// @throws std::invalid_argument as check_trajectories.
SE3 align_umeyama(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// T_truth_estimate for the chosen alignment. @throws std::invalid_argument as check_trajectories.
SE3 alignment_of(const std::vector<SE3>& truth, const std::vector<SE3>& estimate, Alignment alignment);

/// `poses`, each multiplied by `T` from the left.
std::vector<SE3> moved(const std::vector<SE3>& poses, const SE3& T);

/// @throws std::invalid_argument unless both have the same length of at least two poses, all of them finite.
void check_trajectories(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// Length of the path up to each pose (m), starting with 0.
std::vector<double> path_lengths(const std::vector<SE3>& poses);

/// Absolute errors of one trajectory.
struct AbsolutePoseError {
  Alignment alignment = Alignment::kUmeyama;
  SE3 T_truth_estimate = SE3::Identity();  ///< motion applied to the estimate
  ErrorSummary translation_m;
  ErrorSummary rotation_deg;
};

/// APE (also ATE; Sturm et al., IROS 2012): distance of positions and angle between orientations after `alignment`.
/// Same figures as `evo_ape --align` (translation part, angle part) for Alignment::kUmeyama.
/// @throws std::invalid_argument as check_trajectories.
AbsolutePoseError absolute_pose_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment);

/// Relative errors of one trajectory.
struct RelativePoseError {
  ErrorSummary translation_m;
  ErrorSummary rotation_deg;
};

/// Error of the motion between consecutive poses (RPE with delta = 1 frame; Sturm et al., IROS 2012).
/// @throws std::invalid_argument as check_trajectories.
RelativePoseError rpe_per_frame(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// Error of the motion per metre of true path. Every pose starts a pair that ends at the first pose at least 1 m
/// farther along the true path; errors are divided by the length of path between the two, so that fast drives, whose
/// poses lie more than a metre apart, stay comparable. Units: m per m, degrees per m. No pair (count = 0) on paths
/// below 1 m.
/// @throws std::invalid_argument as check_trajectories.
RelativePoseError rpe_per_metre(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// Error of one pose.
struct ErrorSample {
  double distance_m = 0;     ///< along the true path
  double translation_m = 0;  ///< norm of axis_m
  double rotation_deg = 0;
  Eigen::Vector3d axis_m = Eigen::Vector3d::Zero();  ///< estimate − truth along the axes of the true pose
};

/// One sample per pose after `alignment`. The axes are those of the true pose at that time: for poses of a LiDAR
/// (x forward, y left, z up) they read along-track, cross-track and height drift.
/// @throws std::invalid_argument as check_trajectories.
std::vector<ErrorSample> error_series(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment);

}  // namespace rilo
