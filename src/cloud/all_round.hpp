// Sweeps of sensors that turn.
#pragma once

#include <bitset>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/azimuth_sector.hpp"
#include "cloud/measured_point.hpp"
#include "cloud/sensor_axis.hpp"

namespace rilo {

/// Whether points lie in nearly all directions around the z axis.
inline bool all_round(const std::vector<Eigen::Vector3f>& points) {
  constexpr std::size_t kNearlyAll = 33;
  std::bitset<kAzimuthSectors> seen;
  for (const Eigen::Vector3f& p : points) {
    if (detail::is_measured(p) && !detail::is_near_axis(p)) {
      seen.set(azimuth_sector(p));
    }
  }
  return seen.count() >= kNearlyAll;
}

}  // namespace rilo
