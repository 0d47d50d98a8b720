#include "view/budgeted_map.hpp"

#include <numbers>
#include <stdexcept>

#include "geometry/voxel_key.hpp"

namespace rilo {

namespace {
constexpr double kVoxels = 1 << 20;  // of voxel_key() to each side
}

BudgetedMap::BudgetedMap(double voxel_m, std::size_t max_points) : voxel_m_(voxel_m), max_points_(max_points) {
  if (!(voxel_m > 0.0) || max_points == 0) throw std::invalid_argument("BudgetedMap: voxel and budget are positive");
}

void BudgetedMap::add(std::span<const Eigen::Vector3f> points, std::uint32_t sweep) {
  for (const Eigen::Vector3f& p : points) {
    if (!take(p)) continue;
    points_.push_back({p, sweep});
    if (points_.size() > max_points_) coarsen();
  }
}

bool BudgetedMap::take(const Eigen::Vector3f& p) {
  if (!(static_cast<double>(p.cwiseAbs().maxCoeff()) < kVoxels * voxel_m_) || !p.allFinite()) return false;
  return taken_.insert(voxel_key(voxel_of(p, 1.0 / voxel_m_))).second;
}

void BudgetedMap::coarsen() {
  const std::size_t goal = (max_points_ + 1) / 2;
  while (points_.size() > goal) {
    voxel_m_ *= std::numbers::sqrt2;
    taken_.clear();
    std::erase_if(points_, [this](const MapPoint& point) { return !take(point.p); });
  }
  ++epoch_;
}

}  // namespace rilo
