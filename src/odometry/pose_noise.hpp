// How far apart two good poses of one sweep may lie.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

inline constexpr double kPoseNoiseM = 0.1;
inline constexpr double kPoseNoiseRad = 0.02;

/// Of a motion, as a twist [rad; m].
inline bool within_pose_noise(const Vector6d& motion) {
  return motion.head<3>().norm() < kPoseNoiseRad && motion.tail<3>().norm() < kPoseNoiseM;
}

}  // namespace rilo
