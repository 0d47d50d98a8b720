// The local map: surface elements around the sensor at several voxel sizes.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"
#include "rilo/map/local_map_config.hpp"
#include "rilo/map/plane_grid.hpp"

namespace rilo {

/// Voxel map with a plane per voxel. Thread-safe to read from many threads; insert and evict need it alone.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapConfig& config);

  /// Adds points of the sensor frame at the pose `T_odom_lidar`, then fits the planes that changed.
  void insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar);

  /// Drops voxels far from `centre` (odometry frame), a slice per call.
  void evict(const Eigen::Vector3d& centre);

  /// Surface element nearest in scale to `p` (odometry frame): the finest level with a plane there. False when there is none.
  bool find(const Eigen::Vector3d& p, MapPlane& plane) const;

  bool empty() const { return grids_.front().size() == 0; }
  std::size_t size() const { return grids_.front().size(); }

  /// One point for each finest voxel: the centroid of its points (odometry frame, m).
  std::vector<Eigen::Vector3f> points() const;

  void clear();

 private:
  LocalMapConfig config_;
  std::vector<PlaneGrid> grids_;  // finest first
};

}  // namespace rilo
