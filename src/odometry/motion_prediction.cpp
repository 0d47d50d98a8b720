#include "odometry/motion_prediction.hpp"

namespace rilo {

namespace {

double seconds(std::int64_t from_ns, std::int64_t to_ns) { return static_cast<double>(to_ns - from_ns) * 1e-9; }

/// log ΔT_j / Δt_j of two consecutive poses.
Vector6d velocity(const StampedPose& a, const StampedPose& b) {
  const double dt = seconds(a.stamp_ns, b.stamp_ns);
  return se3_log(a.T_odom_lidar.inverse() * b.T_odom_lidar) / dt;
}

}  // namespace

double recent_weight(double sigma_th_m, const MotionPredictionConfig& config) {
  return 0.5 + 0.5 * sigma_th_m / (sigma_th_m + config.recent_half_sigma_m);
}

Vector6d predict_velocity(const Trajectory& past, double sigma_th_m, const MotionPredictionConfig& config) {
  const std::size_t n = past.size();
  if (!config.enabled || n < 2) {
    return Vector6d::Zero();
  }
  Vector6d recent = velocity(past[n - 2], past[n - 1]);
  if (n == 2) {
    return recent;
  }
  // (III-B) weighted mean of the increments, on se(3) instead of on matrices, which would leave SE(3).
  const double w_r = recent_weight(sigma_th_m, config);
  return (1.0 - w_r) * velocity(past[n - 3], past[n - 2]) + w_r * recent;
}

SE3 predict_pose(const Trajectory& past, std::int64_t stamp_ns, double sigma_th_m,
                 const MotionPredictionConfig& config) {
  if (past.empty()) {
    return SE3::Identity();
  }
  const double dt = seconds(past.back().stamp_ns, stamp_ns);
  return past.back().T_odom_lidar * se3_exp(dt * predict_velocity(past, sigma_th_m, config));
}

}  // namespace rilo
