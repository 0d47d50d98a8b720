#include "odometry/turn_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace rilo {

namespace {
constexpr double kShare = 0.02;   // of a sweep in the running means: over about five seconds
constexpr double kBefore = 10.0;  // sweeps that the configured value counts for

/// Times the angular acceleration that has the mean squares `squares`.
MotionPriorConfig scaled(MotionPriorConfig config, const Eigen::Vector3d& squares) {
  config.angular_acceleration_rad_s2 *= std::sqrt(squares.maxCoeff());
  return config;
}
}  // namespace

MotionPriorConfig TurnNoise::expected() const {
  return config_.learn ? scaled(config_, squares_.cwiseMax(1.0)) : config_;
}

void TurnNoise::learn(const MotionState& predicted, const Matrix6d& velocity_covariance, const TimeStep& step,
                      const IcpResult& icp) {
  if (!config_.enabled || !config_.learn) {
    return;
  }
  const MotionPriorConfig known = scaled(config_, squares_);
  const MotionPrior prior = motion_prior(predicted, velocity_covariance, step, known);
  // The change of velocity and the error of the prior have one cause: change = gain · error, on average.
  const double dt_s = step.s;
  const Matrix6d Q = acceleration_density(known);
  Eigen::Matrix<double, 6, 12> covariance;
  covariance << 0.5 * dt_s * dt_s * Q, dt_s * Q;
  const Eigen::Matrix<double, 6, 12> gain = covariance * prior.information;
  const Matrix12d posterior = (prior.information + icp.sweep_information).ldlt().solve(Matrix12d::Identity());
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  const Vector6d mean = gain * prior_error(prior, icp.state);
  const Matrix6d variance = dt_s * Q - gain * covariance.transpose() + gain * posterior * gain.transpose();
  const Eigen::Vector3d expected =
      (R.transpose() * mean.head<3>()).cwiseAbs2() + (R.transpose() * variance.topLeftCorner<3, 3>() * R).diagonal();
  const double unit = dt_s * acceleration_density(config_)(0, 0);
  ++sweeps_;
  squares_ += std::max(kShare, 1.0 / (kBefore + sweeps_)) * (expected / unit - squares_);
}

}  // namespace rilo
