// Points that are measurements, and times that are those of a sweep.
#pragma once

#include <limits>

#include <Eigen/Core>

namespace rilo::detail {

/// Farther from the sweep's stamp (s), times are in another unit or of a clock.
inline constexpr float kFarthestFromStampS = 2.5F;

/// Finite, and not the origin, which drivers write where nothing returned.
inline bool is_measured(const Eigen::Vector3f& point) {
  const float square = point.squaredNorm();
  return square > 0 && square <= std::numeric_limits<float>::max();
}

}  // namespace rilo::detail
