// How abruptly this sensor turns.
#pragma once

#include "odometry/motion_prior.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Angular acceleration of the motion prior, learnt from the sweeps so far by expectation and maximisation (Shumway and
/// Stoffer 1982), running: a hand turns more abruptly than a vehicle. What a sweep does not observe is expected to be
/// as before, so that nothing is learnt about a direction that nobody sees.
class TurnNoise {
 public:
  explicit TurnNoise(const MotionPriorConfig& config) : config_(config) {}

  /// The configuration with the angular acceleration to expect: at least the configured one.
  MotionPriorConfig expected() const;

  /// Takes a sweep registered a `step` (> 0) after the last one; `predicted` and `velocity_covariance` as for
  /// motion_prior().
  void learn(const MotionState& predicted, const Matrix6d& velocity_covariance, const TimeStep& step,
             const IcpResult& icp);

 private:
  MotionPriorConfig config_;
  Eigen::Vector3d squares_ = Eigen::Vector3d::Ones();  // about the sensor's axes, in squares of the configured one
  int sweeps_ = 0;
};

}  // namespace rilo
