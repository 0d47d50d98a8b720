// The map of a whole run: one point a voxel.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Points in the odometry frame (m). The other columns are empty or as long as `points`.
struct MapCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< unit, on the side the surface was seen from; zero where there is none
  std::vector<float> intensities;        ///< sensor units
};

/// Collects points of many sweeps and keeps the first one of every voxel. Memory grows with the area seen, not with
/// time.
class ThinnedMap {
 public:
  /// Smaller voxels would share their keys, larger ones are no map (m).
  static constexpr double kLeastVoxelM = 0.001;
  static constexpr double kMostVoxelM = 100.0;

  explicit ThinnedMap(double voxel_m) : voxel_m_(voxel_m) {}

  /// Adds points of the sensor frame (m, finite) seen at `T_odom_lidar`; `intensities`: empty for all sweeps, or as
  /// long as the points.
  void add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
           const std::vector<float>& intensities = {});

  /// Odometry frame, m.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

  /// The points with their intensities and, when wanted, normals.
  MapCloud cloud(bool with_normals) const;

 private:
  double voxel_m_;
  std::unordered_set<std::uint64_t> taken_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> intensities_;
  std::vector<std::uint32_t> sweeps_;    // which one each point is of
  std::vector<Eigen::Vector3f> places_;  // of the sensor, by sweep
};

}  // namespace rilo
