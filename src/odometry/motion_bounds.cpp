#include "odometry/motion_bounds.hpp"

#include <algorithm>

#include "odometry/pose_noise.hpp"

namespace rilo {

namespace {
// Stamps of arrival jitter. Up to this ratio of two steps' times the motion per sweep may be the steadier one.
constexpr double kMostJitter = 3.0;
constexpr double kLongestSweepS = 0.1;  // where sweeps are missing, one takes no longer than usual

struct Size {
  double metres = 0;
  double radians = 0;
};

Size size_of(const SE3& T) { return {T.translation().norm(), rotation_angle_rad(T)}; }
}  // namespace

bool possible_motion(const SE3& step, double step_s, const std::optional<SE3>& before, double before_s,
                     const MotionBoundsConfig& config) {
  const Size whole = size_of(step);
  if (whole.metres > config.max_speed_m_s * step_s + kPoseNoiseM ||
      whole.radians > config.max_turn_rate_rad_s * step_s + kPoseNoiseRad) {
    return false;
  }
  if (!before) {
    return true;
  }
  // The mean velocities of both steps belong to their middles.
  const double between_s = 0.5 * (step_s + before_s);
  const double ratio = step_s / before_s;
  const double noise = 1.0 + ratio;  // that of the step before is carried on with its velocity
  const auto within = [&](double scale) {
    const Size change = size_of(se3_exp(scale * se3_log(*before)).inverse() * step);
    return change.metres <= config.max_acceleration_m_s2 * between_s * step_s + noise * kPoseNoiseM &&
           change.radians <= config.max_angular_acceleration_rad_s2 * between_s * step_s + noise * kPoseNoiseRad;
  };
  return within(ratio) || (std::max(ratio, 1.0 / ratio) <= kMostJitter && within(1.0));
}

bool possible_change(const Vector6d& velocity_change, double dt_s, const MotionBoundsConfig& config) {
  const double sweep_s = std::min(dt_s, kLongestSweepS);
  return velocity_change.tail<3>().norm() <= config.max_acceleration_m_s2 * dt_s + kPoseNoiseM / sweep_s &&
         velocity_change.head<3>().norm() <= config.max_angular_acceleration_rad_s2 * dt_s + kPoseNoiseRad / sweep_s;
}

}  // namespace rilo
