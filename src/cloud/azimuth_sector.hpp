// Directions around the z axis.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Core>

namespace rilo {

inline constexpr std::size_t kAzimuthSectors = 36;  // of 10°

/// Of a finite point; the first one begins straight behind.
inline std::size_t azimuth_sector(const Eigen::Vector3f& p) {
  const double turn = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())) / (2.0 * std::numbers::pi);
  return std::min(static_cast<std::size_t>((turn + 0.5) * kAzimuthSectors), kAzimuthSectors - 1);
}

}  // namespace rilo
