#include "cloud/point_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace rilo {

namespace {
constexpr float kSlack2 = 1e-6F;  // m²: the bound of a cell is rounded, a millimetre is on the safe side

bool closer(const Neighbour& a, const Neighbour& b) {
  return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.index < b.index);
}
}  // namespace

// The points of a cell stay in their order.
void PointGrid::build(const std::vector<Eigen::Vector3f>& points) {
  points_ = points;
  cells_.assign(std::bit_ceil(points_.size() * 2 + 16), Cell{});
  const std::size_t mask = cells_.size() - 1;
  std::vector<std::size_t> slots(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint64_t key = voxel_key(voxel_of(points_[i], inverse_));
    std::size_t slot = mix_key(key) & mask;
    while (cells_[slot].end != 0 && cells_[slot].key != key) {
      slot = (slot + 1) & mask;
    }
    cells_[slot].key = key;
    ++cells_[slot].end;  // for now their number
    slots[i] = slot;
  }
  std::uint32_t next = 0;
  for (Cell& cell : cells_) {
    cell.begin = next;
    next += cell.end;
    cell.end = cell.begin;
  }
  order_.resize(points_.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    order_[cells_[slots[i]].end++] = i;
  }
}

const PointGrid::Cell* PointGrid::find_cell(const VoxelIndex& index) const {
  const std::uint64_t key = voxel_key(index);
  const std::size_t mask = cells_.size() - 1;
  for (std::size_t slot = mix_key(key) & mask; cells_[slot].begin != cells_[slot].end; slot = (slot + 1) & mask) {
    if (cells_[slot].key == key) {
      return &cells_[slot];
    }
  }
  return nullptr;
}

template <typename Visit>
void PointGrid::visit_ring(const Eigen::Vector3f& p, const VoxelIndex& centre, int ring, const float& limit2,
                           const Visit& visit) const {
  const auto cell_m = static_cast<float>(cell_m_);
  const Eigen::Vector3f corner(static_cast<float>(centre.x), static_cast<float>(centre.y),
                               static_cast<float>(centre.z));
  const Eigen::Vector3f inside = p - cell_m * corner;  // 0 … cell_m
  // Squared distance along an axis to the nearest face of the cells `step` away.
  const auto face2 = [&](int step, float at) {
    const float d =
        step == 0 ? 0.0F
                  : (step > 0 ? static_cast<float>(step) * cell_m - at : at - static_cast<float>(step + 1) * cell_m);
    return d * d;
  };
  for (int dz = -ring; dz <= ring; ++dz) {
    const float z2 = face2(dz, inside.z());
    for (int dy = -ring; dy <= ring; ++dy) {
      const float yz2 = z2 + face2(dy, inside.y());
      const bool face = std::abs(dz) == ring || std::abs(dy) == ring;
      const int step =
          face || ring == 0 ? 1 : 2 * ring;  // inside the shell only the two end cells of a row belong to it
      for (int dx = -ring; dx <= ring; dx += step) {
        if (yz2 + face2(dx, inside.x()) > limit2 + kSlack2) {
          continue;
        }
        const Cell* cell = find_cell({centre.x + dx, centre.y + dy, centre.z + dz});
        if (cell == nullptr) {
          continue;
        }
        for (std::uint32_t i = cell->begin; i < cell->end; ++i) {
          visit(order_[i], (points_[order_[i]] - p).squaredNorm());
        }
      }
    }
  }
}

bool PointGrid::nearest(const Eigen::Vector3f& p, double max_distance_m, Neighbour& found, std::uint32_t guess) const {
  if (points_.empty()) {
    return false;
  }
  const VoxelIndex centre = voxel_of(p, inverse_);
  const auto limit2 = static_cast<float>(max_distance_m * max_distance_m);
  Neighbour best{kNoPoint, limit2};
  if (guess != kNoPoint) {
    const Neighbour guessed{guess, (points_[guess] - p).squaredNorm()};
    best = closer(guessed, best) ? guessed : best;
  }
  const int rings = static_cast<int>(std::ceil(max_distance_m * inverse_));
  for (int ring = 0; ring <= rings; ++ring) {
    visit_ring(p, centre, ring, best.distance2, [&](std::uint32_t index, float distance2) {
      const Neighbour candidate{index, distance2};
      if (closer(candidate, best)) {
        best = candidate;
      }
    });
    // A point of the next ring is at least `ring` cells away.
    const double reach = ring * cell_m_;
    if (best.index != kNoPoint && static_cast<double>(best.distance2) <= reach * reach) {
      break;
    }
  }
  found = best;
  return best.index != kNoPoint;
}

void PointGrid::nearest(const Eigen::Vector3f& p, std::size_t k, double max_distance_m,
                        std::vector<Neighbour>& found) const {
  found.clear();
  if (points_.empty() || k == 0) {
    return;
  }
  const VoxelIndex centre = voxel_of(p, inverse_);
  const auto limit2 = static_cast<float>(max_distance_m * max_distance_m);
  const int rings = static_cast<int>(std::ceil(max_distance_m * inverse_));
  float worst2 = limit2;
  for (int ring = 0; ring <= rings; ++ring) {
    visit_ring(p, centre, ring, worst2, [&](std::uint32_t index, float distance2) {
      const Neighbour candidate{index, distance2};
      if (distance2 > limit2 || (found.size() == k && !closer(candidate, found.back()))) {
        return;
      }
      found.insert(std::upper_bound(found.begin(), found.end(), candidate, closer), candidate);
      if (found.size() > k) {
        found.pop_back();
      }
      if (found.size() == k) {
        worst2 = found.back().distance2;
      }
    });
    const double reach = ring * cell_m_;
    if (found.size() == k && static_cast<double>(found.back().distance2) <= reach * reach) {
      break;
    }
  }
}

std::size_t PointGrid::count_within(const Eigen::Vector3f& p, double radius_m) const {
  if (points_.empty()) {
    return 0;
  }
  const VoxelIndex centre = voxel_of(p, inverse_);
  const auto radius2 = static_cast<float>(radius_m * radius_m);
  const int rings = static_cast<int>(std::ceil(radius_m * inverse_));
  std::size_t count = 0;
  for (int ring = 0; ring <= rings; ++ring) {
    visit_ring(p, centre, ring, radius2,
               [&](std::uint32_t, float distance2) { count += distance2 <= radius2 ? 1 : 0; });
  }
  return count;
}

}  // namespace rilo
