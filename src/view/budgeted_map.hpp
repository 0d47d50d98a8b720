// A map that gets coarser rather than larger.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// A point of the map and the sweep that it was first seen in.
struct MapPoint {
  Eigen::Vector3f p;        ///< odometry frame, m
  std::uint32_t sweep = 0;  ///< counted from 0
};

/// Keeps the first point of every voxel. When there would be more than `max_points`, the voxels grow by √2 until the
/// map fits into half of that, the same points as if the voxels had been so large from the beginning.
class BudgetedMap {
 public:
  /// @throws std::invalid_argument when an argument is not positive.
  BudgetedMap(double voxel_m, std::size_t max_points);

  /// Adds points of the odometry frame (m). Those that are not finite, or farther than ±2^20 voxels, are dropped.
  void add(std::span<const Eigen::Vector3f> points, std::uint32_t sweep);

  /// In the order in which they came.
  const std::vector<MapPoint>& points() const { return points_; }

  /// Grows by one whenever the map gets coarser: points() is then another list than before.
  std::uint32_t epoch() const { return epoch_; }
  double voxel_m() const { return voxel_m_; }

 private:
  bool take(const Eigen::Vector3f& p);
  void coarsen();

  double voxel_m_;
  std::size_t max_points_;
  std::uint32_t epoch_ = 0;
  std::unordered_set<std::uint64_t> taken_;
  std::vector<MapPoint> points_;
};

}  // namespace rilo
