// The map of a whole run: one point a voxel.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <unordered_map>
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
/// time, by some 20 bytes a point; nothing that grows is ever moved as a whole, so that no sweep waits for it.
class ThinnedMap {
 public:
  /// Smaller voxels would share their keys, larger ones are no map (m).
  static constexpr double kLeastVoxelM = 0.001;
  static constexpr double kMostVoxelM = 100.0;

  /// @throws std::invalid_argument for a voxel below kLeastVoxelM or above kMostVoxelM.
  explicit ThinnedMap(double voxel_m);

  /// Adds points of the sensor frame (m, finite) seen at `T_odom_lidar`; `intensities`: empty for all sweeps, or as
  /// long as the points. @throws std::invalid_argument for another number of them.
  void add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
           const std::vector<float>& intensities = {});

  /// Number of points.
  std::size_t size() const { return points_.size(); }

  /// A copy; odometry frame, m.
  std::vector<Eigen::Vector3f> points() const { return {points_.begin(), points_.end()}; }

  /// The points with their intensities and, when wanted, normals.
  MapCloud cloud(bool with_normals) const;

 private:
  // Whether there is a point, of 16 × 16 × 16 voxels.
  using Block = std::bitset<4096>;

  bool take(const Eigen::Vector3d& point, double inverse_voxel);

  double voxel_m_;
  std::unordered_map<std::uint64_t, Block> taken_;  // by the key of the block
  std::deque<Eigen::Vector3f> points_;
  std::deque<float> intensities_;
  std::deque<std::uint32_t> sweeps_;     // which one each point is of
  std::vector<Eigen::Vector3f> places_;  // of the sensor, by sweep
};

}  // namespace rilo
