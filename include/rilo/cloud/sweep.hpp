// One sweep as it comes from the sensor.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// One sweep of a LiDAR. Points are in the sensor frame (x forward, y left, z up, metres), each at its own instant.
/// The optional columns are empty or as long as `points`. NaN points are allowed and are dropped by the odometry.
struct Sweep {
  std::int64_t stamp_ns = 0;            ///< the instant that `times_s` counts from
  std::vector<Eigen::Vector3f> points;  ///< m
  std::vector<float> times_s;           ///< s relative to stamp_ns; empty: no times, or already motion-compensated
  std::vector<float> intensities;       ///< sensor units
  std::vector<std::uint16_t> rings;     ///< beam index
};

}  // namespace rilo
