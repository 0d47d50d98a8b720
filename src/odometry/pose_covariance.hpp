// How sure a registered pose is.
#pragma once

#include "registration/adaptive_icp.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Covariance of a pose given the one before: the evidence of the sweep and the motion prior, and what the sweep's
/// points are off by because the velocity changed while they were measured, steadily or to and fro. Learns how the
/// sensor is moved.
class PoseCovariance {
 public:
  /// Of the pose of `icp`, right perturbation, [rad; m].
  /// @param degenerate a direction is not observed.
  /// @param acceleration from the sweep before [rad/s²; m/s²].
  /// @param sweep_s how long the points were measured; 0 for points that were motion-compensated before.
  /// @param uneven uneven_motion() of the sweep [rad²; m²].
  Matrix6d of(const IcpResult& icp, bool degenerate, const Vector6d& acceleration, double sweep_s,
              const Vector6d& uneven);

  /// Share of the residuals that count as independent where a direction is observed.
  static double evidence_share(const AdaptiveIcpConfig& config);

  void reset() { *this = {}; }

 private:
  Vector6d acceleration_ = Vector6d::Zero();  // to the last sweep
  // Means of the last sweeps: acceleration that points are not compensated for, and scatter of motion within a sweep.
  Vector6d squared_acceleration_ = Vector6d::Zero();
  Vector6d uneven_ = Vector6d::Zero();
};

}  // namespace rilo
