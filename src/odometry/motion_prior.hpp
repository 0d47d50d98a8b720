// Prior of the next pose and velocity from the motion so far.
#pragma once

#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Covariance of an unknown velocity: a car on a motorway, a sensor turned by hand ([rad/s; m/s] squared).
Matrix6d unknown_velocity_covariance();

/// Covariance of a pose that is a guess ([rad; m] squared): as far as an unknown velocity leads in a second.
Matrix6d guess_covariance();

/// Power density Q of the acceleration, white noise ([rad/s²; m/s²] squared times s).
Matrix6d acceleration_density(const MotionPriorConfig& config);

/// Covariance of the pose, [rad; m] squared, `dt_s` after a certain one, when the velocity performs a random walk.
Matrix6d pose_covariance_after(const Matrix6d& velocity_covariance, double dt_s, const MotionPriorConfig& config);

/// Time from one sweep to another.
struct TimeStep {
  double s = 0;        ///< < 0: to an earlier one
  double error_s = 0;  ///< standard deviation
};

/// Prior of pose and velocity a `step` after a pose taken as certain (odometry is relative) with the velocity
/// covariance `velocity_covariance` [rad/s; m/s]; the velocity performs a random walk. `predicted` is the mean. It
/// holds the directions that a sweep does not constrain, and it ties the velocity during the sweep to the displacement
/// since the last. Zero information when off.
MotionPrior motion_prior(const MotionState& predicted, const Matrix6d& velocity_covariance, const TimeStep& step,
                         const MotionPriorConfig& config);

/// Mean of the prior: `last` moved on by `dt_s`. Speed is kept; the turn rate fades within about a second, since
/// vehicles end their turns, and a turn rate that nothing observes (an open field) would run away.
MotionState expected_motion(const MotionState& last, double dt_s);

}  // namespace rilo
