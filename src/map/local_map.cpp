#include "rilo/map/local_map.hpp"

namespace rilo {

LocalMap::LocalMap(const LocalMapConfig& config) : config_(config) {
  clear();
}

void LocalMap::clear() {
  grids_.clear();
  double voxel = config_.voxel_m;
  for (int level = 0; level < config_.levels; ++level, voxel *= 2.0) {
    grids_.emplace_back(voxel, PlaneCriteria{config_.min_points, config_.max_points, config_.max_planarity,
                                             config_.min_extent * voxel});
  }
}

void LocalMap::insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar) {
  for (PlaneGrid& grid : grids_) {
    for (const Eigen::Vector3f& p : points) {
      grid.insert(T_odom_lidar * p.cast<double>());
    }
    grid.refit();
  }
}

void LocalMap::evict(const Eigen::Vector3d& centre) {
  for (PlaneGrid& grid : grids_) {
    grid.evict(centre, config_.radius_m);
  }
}

bool LocalMap::find(const Eigen::Vector3d& p, MapPlane& plane) const {
  for (const PlaneGrid& grid : grids_) {
    if (grid.find(p, plane)) {
      return true;
    }
  }
  return false;
}

std::vector<Eigen::Vector3f> LocalMap::points() const {
  std::vector<Eigen::Vector3f> out;
  out.reserve(size());
  grids_.front().centroids(out);
  return out;
}

}  // namespace rilo
