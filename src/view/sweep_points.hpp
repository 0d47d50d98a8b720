// Of a sweep, the points that are shown.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "map/plane_grid.hpp"
#include "rilo/odometry/sweep_result.hpp"
#include "view/view_sweep.hpp"

namespace rilo::view {

/// Columns are empty or as long as `points`.
struct SweepPoints {
  std::vector<Eigen::Vector3f> points;  ///< motion-compensated, sensor frame at the time of the pose, m
  std::vector<float> intensities;       ///< sensor units
  std::vector<float> times_s;           ///< since the time of the pose
  std::vector<float> residuals_m;       ///< distance to the plane of the map; NaN: no plane there
};

/// Every n-th of the points within `min_range_m` … `max_range_m`, at most `max_points`; `phase` moves the choice, so
/// that successive sweeps show different points.
SweepPoints sample_sweep(const ViewSweep& sweep, std::size_t max_points, double min_range_m, double max_range_m,
                         std::size_t phase);

/// Planes of the sweeps shown so far, to measure the next one against: not the local map of the odometry, which the
/// viewer leaves alone.
class ResidualMap {
 public:
  ResidualMap();

  /// Fills the residuals of `sweep` at `T_odom_lidar` (before it takes part in the map itself).
  void measure(const SE3& T_odom_lidar, SweepPoints& sweep) const;
  void add(const SE3& T_odom_lidar, const SweepPoints& sweep);

 private:
  PlaneGrid grid_;
};

}  // namespace rilo::view
