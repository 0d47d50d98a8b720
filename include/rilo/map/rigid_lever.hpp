// How a pose and what is fixed to it move with a parameter.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rilo {

/// Derivative of a rigid motion by a scalar parameter, odometry frame.
struct RigidLever {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       ///< point that the translation is of (m)
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rad per unit
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m per unit

  /// Derivative of the point `p`.
  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return translation + rotation.cross(p - origin); }
};

}  // namespace rilo
