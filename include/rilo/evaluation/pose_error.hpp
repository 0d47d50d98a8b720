// Errors of the poses of a trajectory against the true one: absolute, relative, and along the way.
#pragma once

#include <vector>

#include "rilo/evaluation/alignment.hpp"
#include "rilo/evaluation/error_summary.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

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
