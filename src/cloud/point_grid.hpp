// Neighbour search in one cloud: points sorted into the cells of a hash grid.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geometry/voxel_key.hpp"

namespace rilo {

/// A neighbour: index into the cloud and squared distance (m²).
struct Neighbour {
  std::uint32_t index = 0;
  float distance2 = 0;
};

inline constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

/// Grid over a cloud of finite points. Reading is thread-safe. Ties are broken by the smaller index, so that results do
/// not depend on the order in which cells are visited.
class PointGrid {
 public:
  explicit PointGrid(double cell_m) : cell_m_(cell_m), inverse_(1.0 / cell_m) {}

  /// Copies `points` and sorts them into cells.
  void build(const std::vector<Eigen::Vector3f>& points);

  const std::vector<Eigen::Vector3f>& points() const { return points_; }

  /// Nearest point within `max_distance_m`; false when there is none. `guess`: a point that may well be it, which
  /// shortens the search and does not change its result.
  bool nearest(const Eigen::Vector3f& p, double max_distance_m, Neighbour& found, std::uint32_t guess = kNoPoint) const;

  /// The `k` nearest points within `max_distance_m`, nearest first; fewer when there are not as many.
  void nearest(const Eigen::Vector3f& p, std::size_t k, double max_distance_m, std::vector<Neighbour>& found) const;

  /// Number of points within `radius_m`, the point itself included.
  std::size_t count_within(const Eigen::Vector3f& p, double radius_m) const;

 private:
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  // begin == end: free slot
  };

  const Cell* find_cell(const VoxelIndex& index) const;

  /// Calls visit(point index, squared distance) for every point of the cells at Chebyshev distance `ring` around
  /// `centre`, but for cells that lie wholly beyond `limit2`, a squared distance that may shrink on the way.
  template <typename Visit>
  void visit_ring(const Eigen::Vector3f& p, const VoxelIndex& centre, int ring, const float& limit2,
                  const Visit& visit) const;

  double cell_m_;
  double inverse_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint32_t> order_;  // indices sorted by cell
  std::vector<Cell> cells_;           // open addressing
};

}  // namespace rilo
