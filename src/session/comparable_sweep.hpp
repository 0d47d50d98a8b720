// Sweeps that can tell raw points from compensated ones.
#pragma once

#include "odometry/pose_noise.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

inline bool registered(const SweepResult& result) {
  return result.status == OdometryStatus::kOk || result.status == OdometryStatus::kDegenerate;
}

/// By more than the noise of good poses, in a turn of `turn_s`.
inline bool moved(const SweepResult& result, double turn_s) {
  return turn_s * result.twist.head<3>().norm() > kPoseNoiseRad || turn_s * result.twist.tail<3>().norm() > kPoseNoiseM;
}

}  // namespace rilo
