// The map of a whole run: one point a voxel.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Collects points of many sweeps and keeps the first one of every voxel. Memory grows with the area seen, not with
/// time.
class ThinnedMap {
 public:
  explicit ThinnedMap(double voxel_m) : inverse_(1.0 / voxel_m) {}

  /// Adds points of the sensor frame (m, finite) seen at `T_odom_lidar`.
  void add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar);

  /// Odometry frame, m.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  double inverse_;
  std::unordered_set<std::uint64_t> taken_;
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace rilo
