// Error as a function of the distance travelled, for plots.
#pragma once

#include <vector>

#include "rilo/evaluation/alignment.hpp"

namespace rilo {

/// Error of one pose.
struct ErrorSample {
  double distance_m = 0;     ///< along the true path
  double translation_m = 0;  ///< norm of axis_m
  double rotation_deg = 0;
  Eigen::Vector3d axis_m = Eigen::Vector3d::Zero();  ///< estimate − truth along the axes of the true pose
};

/// One sample a pose after `alignment`. The axes are those of the true pose at that instant: for poses of a LiDAR
/// (x forward, y left, z up) they read along-track, cross-track and height drift.
/// @throws std::invalid_argument as check_trajectories.
std::vector<ErrorSample> error_series(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment);

}  // namespace rilo
