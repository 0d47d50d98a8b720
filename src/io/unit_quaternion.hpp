// Rotations as files hold them.
#pragma once

#include <Eigen/Geometry>

#include "rilo/geometry/se3.hpp"

namespace rilo::detail {

/// The rotation of `pose`, w >= 0: of the two quaternions of a rotation always the same one.
inline Eigen::Quaterniond unit_quaternion(const SE3& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() *= -1;
  return q;
}

}  // namespace rilo::detail
