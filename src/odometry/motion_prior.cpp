#include "odometry/motion_prior.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace rilo {

namespace {
// The configured accelerations are changes over this time.
constexpr double kUnitTimeS = 0.1;
constexpr double kUnknownTurnRate = 1.0;  // rad/s: a sensor turned by hand
constexpr double kUnknownSpeed = 20.0;    // m/s: a car on a motorway
constexpr double kTurnMemoryS = 1.0;      // vehicles end their turns
}  // namespace

Matrix6d unknown_velocity_covariance() {
  Vector6d variance;
  variance.head<3>().setConstant(kUnknownTurnRate * kUnknownTurnRate);
  variance.tail<3>().setConstant(kUnknownSpeed * kUnknownSpeed);
  return variance.asDiagonal();
}

Matrix6d guess_covariance() {
  constexpr double kGuessS = 1.0;
  return kGuessS * kGuessS * unknown_velocity_covariance();
}

MotionState expected_motion(const MotionState& last, double dt_s) {
  MotionState next{last.T_odom_lidar, last.twist};
  next.twist.head<3>() *= std::exp(-dt_s / kTurnMemoryS);
  next.T_odom_lidar = last.T_odom_lidar * se3_exp(dt_s * next.twist);
  return next;
}

Matrix6d acceleration_density(const MotionPriorConfig& config) {
  Vector6d density;
  density.head<3>().setConstant(config.angular_acceleration_rad_s2 * config.angular_acceleration_rad_s2 * kUnitTimeS);
  density.tail<3>().setConstant(config.acceleration_m_s2 * config.acceleration_m_s2 * kUnitTimeS);
  return density.asDiagonal();
}

Matrix6d pose_covariance_after(const Matrix6d& velocity_covariance, double dt_s, const MotionPriorConfig& config) {
  const double dt2 = dt_s * dt_s;
  return dt2 * velocity_covariance + dt2 * std::abs(dt_s) / 3.0 * acceleration_density(config);
}

MotionPrior motion_prior(const MotionState& predicted, const Matrix6d& velocity_covariance, const TimeStep& step,
                         const MotionPriorConfig& config) {
  MotionPrior prior;
  prior.state = predicted;
  if (!config.enabled) {
    return prior;
  }
  const Matrix6d Q = acceleration_density(config);
  const Matrix6d& V = velocity_covariance;
  const double dt_s = step.s;
  const double lag_s = std::abs(dt_s);  // a random walk is one backwards, too
  const Vector6d off = step.error_s * predicted.twist_in_odom();
  Matrix12d P;
  P.topLeftCorner<6, 6>() = pose_covariance_after(V, dt_s, config) + off * off.transpose();
  P.topRightCorner<6, 6>() = dt_s * V + dt_s * lag_s / 2.0 * Q;
  P.bottomLeftCorner<6, 6>() = P.topRightCorner<6, 6>().transpose();
  P.bottomRightCorner<6, 6>() = V + lag_s * Q;
  const Matrix12d information = P.ldlt().solve(Matrix12d::Identity());
  prior.information = 0.5 * (information + information.transpose());
  return prior;
}

}  // namespace rilo
