// One sweep as it comes from the sensor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// One sweep of a LiDAR. Points are in the sensor frame (x forward, y left, z up, metres), each at its own time.
/// The optional columns are empty or as long as `points`. NaN points are allowed and are dropped by the odometry.
struct Sweep {
  std::int64_t stamp_ns = 0;            ///< the time that `times_s` counts from
  std::vector<Eigen::Vector3f> points;  ///< m
  /// s relative to stamp_ns; empty: no times, or already motion-compensated. Points farther than 2.5 s from it are not
  /// used; when most are, times are in another unit, and the sweep counts as empty.
  std::vector<float> times_s;
  std::vector<float> intensities;    ///< sensor units
  std::vector<std::uint16_t> rings;  ///< beam index
};

/// A sweep in memory of another owner, a driver or numpy: nothing is copied. Columns as in Sweep.
struct SweepView {
  SweepView() = default;
  SweepView(const Sweep& sweep)  // NOLINT(google-explicit-constructor): a sweep converts to a view
      : stamp_ns(sweep.stamp_ns),
        points(sweep.points),
        times_s(sweep.times_s),
        intensities(sweep.intensities),
        rings(sweep.rings) {}

  std::int64_t stamp_ns = 0;
  std::span<const Eigen::Vector3f> points;
  std::span<const float> times_s;
  std::span<const float> intensities;
  std::span<const std::uint16_t> rings;
};

}  // namespace rilo
