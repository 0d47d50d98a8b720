// Points that have an azimuth.
#pragma once

#include <Eigen/Core>

namespace rilo::detail {

/// Nearer to the sensor's axis lies what drivers write where nothing returned: no range, and the laser's own offset.
inline constexpr float kNearAxisM = 0.1F;

inline bool is_near_axis(const Eigen::Vector3f& point) {
  return point.head<2>().squaredNorm() < kNearAxisM * kNearAxisM;
}

}  // namespace rilo::detail
