// Where a sensor may be after a gap.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Around where the motion before leads, by the accelerations that the prior expects.
struct Reach {
  SE3 T_odom_centre = SE3::Identity();
  double sigma_m = 0;    ///< standard deviation of the position along its most uncertain direction
  double sigma_rad = 0;  ///< the same of the orientation

  bool contains(const SE3& T_odom_lidar) const {
    constexpr double kSigmas = 3.0;
    const SE3 off = T_odom_centre.inverse() * T_odom_lidar;
    return off.translation().norm() <= kSigmas * sigma_m && rotation_angle_rad(off) <= kSigmas * sigma_rad;
  }
};

}  // namespace rilo
