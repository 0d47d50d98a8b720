// Points that are measurements.
#pragma once

#include <limits>

#include <Eigen/Core>

namespace rilo::detail {

/// Finite, and not the origin, which drivers write where nothing returned.
inline bool is_measured(const Eigen::Vector3f& point) {
  const float square = point.squaredNorm();
  return square > 0 && square <= std::numeric_limits<float>::max();
}

}  // namespace rilo::detail
