#include "rilo/map/local_map.hpp"

#include <algorithm>
#include <cmath>

#include "cloud/fixed_chunks.hpp"
#include "rilo/cloud/elevation.hpp"

namespace rilo {

namespace {

/// Whether `finer`, the next level, has points in the voxel of `coarse` that holds `p`. Its centroid alone does not
/// tell: it may lie in the free space between them.
bool seen_finer(const PlaneGrid& coarse, const PlaneGrid& finer, const Eigen::Vector3f& p) {
  const VoxelIndex index = voxel_of(p, 1.0 / coarse.voxel_m());
  for (int child = 0; child < 8; ++child) {
    const Eigen::Vector3d corner(2 * index.x + (child & 1), 2 * index.y + (child >> 1 & 1), 2 * index.z + (child >> 2));
    if (finer.occupied((corner + Eigen::Vector3d::Constant(0.5)) * finer.voxel_m())) {
      return true;
    }
  }
  return false;
}

}  // namespace

LocalMap::LocalMap(const LocalMapConfig& config) : config_(config) { clear(); }

void LocalMap::clear() {
  grids_.clear();
  double voxel = config_.voxel_m;
  for (int level = 0; level < config_.levels; ++level, voxel *= 2.0) {
    grids_.emplace_back(voxel, PlaneCriteria{config_.min_points, config_.max_points, config_.max_planarity,
                                             config_.min_extent * voxel});
  }
}

void LocalMap::set_scene_range(double range_m) {
  if (!(range_m > 0.0) || !std::isfinite(range_m)) {
    return;  // a sweep without points tells nothing
  }
  const double level = std::round(std::log2(range_m / (config_.scene_voxels * config_.voxel_m)));
  // The coarsest level alone would leave edges and small things out: the one below it is always in use.
  const double last = std::max(0.0, static_cast<double>(config_.levels) - 2.0);
  finest_ = static_cast<std::size_t>(std::clamp(level, 0.0, last));
}

void LocalMap::insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar, const RigidLever& pose) {
  const Eigen::Matrix3f R = T_odom_lidar.linear().cast<float>();
  world_.resize(points.size());
  levers_.resize(points.size());
  for_fixed_chunks(points.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      world_[i] = T_odom_lidar * points[i].cast<double>();
      levers_[i] = R * elevation_lever(points[i]) + pose.at(world_[i]).cast<float>();
    }
  });
  // The levels know nothing of one another.
  for_each_index(grids_.size() - finest_, [&](std::size_t i) {
    PlaneGrid& grid = grids_[finest_ + i];
    grid.insert(world_, levers_);
    grid.refit();
  });
}

void LocalMap::turn_elevation(double angle_rad, const RigidLever& sensor) {
  for (PlaneGrid& grid : grids_) {
    grid.turn_elevation(angle_rad, sensor);
  }
}

void LocalMap::evict(const Eigen::Vector3d& centre) {
  for (PlaneGrid& grid : grids_) {
    grid.evict(centre, config_.radius_m);
  }
}

bool LocalMap::find(const Eigen::Vector3d& p, MapPlane& plane) const {
  PlaneSpot spot;
  if (!locate(p, spot)) {
    return false;
  }
  plane = spot.grid->plane_at(spot);
  return true;
}

bool LocalMap::locate(const Eigen::Vector3d& p, PlaneSpot& spot) const {
  for (std::size_t level = finest_; level < grids_.size(); ++level) {
    if (grids_[level].locate(p, spot)) {
      return true;
    }
  }
  return false;
}

std::size_t LocalMap::size() const {
  std::size_t voxels = 0;
  for (const PlaneGrid& grid : grids_) {
    voxels += grid.size();
  }
  return voxels;
}

std::vector<Eigen::Vector3f> LocalMap::points() const {
  std::vector<Eigen::Vector3f> out;
  for (std::size_t level = 0; level < grids_.size(); ++level) {
    std::vector<Eigen::Vector3f> centroids;
    grids_[level].centroids(centroids);
    std::copy_if(centroids.begin(), centroids.end(), std::back_inserter(out), [&](const Eigen::Vector3f& p) {
      return level == 0 || !seen_finer(grids_[level], grids_[level - 1], p);
    });
  }
  return out;
}

}  // namespace rilo
