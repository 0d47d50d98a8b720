// How sure a registered pose is.
#pragma once

#include "rilo/geometry/se3.hpp"
#include "rilo/registration/adaptive_icp.hpp"

namespace rilo {

/// Covariance of a pose given the one before: the evidence of the sweep and the motion prior, and what the sweep's
/// points are off by because the velocity changed while they were measured. Learns how the sensor is moved.
class PoseCovariance {
 public:
  /// Of the pose of `icp`, right perturbation, [rad; m].
  /// @param degenerate a direction is not observed.
  /// @param before velocity during the sweep before [rad/s; m/s].
  /// @param sweep_s how long the points were measured; 0 for points that were brought to one instant before.
  Matrix6d of(const IcpResult& icp, bool degenerate, const Vector6d& before, double sweep_s);

  void reset() { *this = {}; }

 private:
  Vector6d squared_change_ = Vector6d::Zero();  // of the velocity from sweep to sweep, mean of the last ones
};

}  // namespace rilo
