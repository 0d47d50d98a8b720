// How a pose, and what is fixed to it, moves with a scalar parameter.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rilo {

/// Derivative of a rigid motion with respect to a scalar parameter, odometry frame.
struct PoseDerivative {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       ///< point to which the translation refers (m)
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad per unit
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m per unit

  /// Derivative of the point `p`.
  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return translation + rotation.cross(p - origin); }
};

}  // namespace rilo
