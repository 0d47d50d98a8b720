#include "map/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_block.hpp"

namespace rilo {

namespace {

// A larger voxel needs points of several sweeps: the first one alone would fill it from one or two beams.
constexpr double kMorePointsPerLevel = 1.5;
constexpr std::size_t kLevelsUp = 2;  // to a wider plane: the points of the finer one are few of its points

/// Whether `finer`, the next level, has points in the voxel of `coarse` that holds `p`. The centroid is not enough: it
/// may lie in the free space between them.
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
  double most = config_.max_points;
  for (int level = 0; level < config_.levels; ++level, voxel *= 2.0, most *= kMorePointsPerLevel) {
    const auto max_points = static_cast<std::int32_t>(std::min(most, 1e9));
    const bool keep_scatter = config_.scatter_voxel_m > 0.0 && voxel >= config_.scatter_voxel_m;
    grids_.emplace_back(voxel,
                        PlaneCriteria{config_.min_points, max_points, config_.max_planarity, config_.min_extent * voxel,
                                      config_.range_noise_m, config_.angle_noise_rad, keep_scatter});
  }
}

void LocalMap::set_scene_range(double range_m) {
  if (!(range_m > 0.0) || !std::isfinite(range_m)) {
    return;  // a sweep without points
  }
  const double level = std::round(std::log2(range_m / (config_.scene_voxels * config_.voxel_m)));
  // The coarsest level alone would leave edges and small things out: the one below it is always in use.
  const double last = std::max(0.0, static_cast<double>(config_.levels) - 2.0);
  finest_ = static_cast<std::size_t>(std::clamp(level, 0.0, last));
}

void LocalMap::insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
                      const PoseDerivative& pose_by_elevation) {
  const Eigen::Matrix3f R = T_odom_lidar.linear().cast<float>();
  inserted_.resize(points.size());
  voxels_.resize(points.size());
  for_fixed_chunks(points.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    PointBlock p;
    PointBlock rays;
    PointBlock jacobians;
    PlaceBlock places;
    for_each_block(first, last, [&](std::size_t begin, std::size_t n) {
      p.load(&points[begin], n);
      rotate(R, p, rays);
      find_elevation_jacobians(p, jacobians);
      transform(T_odom_lidar, p, places);
      rotate(R, jacobians, p);
      add_derivatives(pose_by_elevation, places, p);
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = begin + k;
        const Eigen::Vector3d place = places.at(k);
        inserted_[i] = {place, rays.at(k), p.at(k)};
        const VoxelIndex voxel = finest_voxel(place);
        voxels_[i] = i == first ? InsertedVoxel(voxel) : InsertedVoxel(voxel, voxels_[i - 1].index);
      }
    });
  });
  // The levels are independent of one another.
  for_each_index(grids_.size() - finest_, [&](std::size_t i) {
    PlaneGrid& grid = grids_[finest_ + i];
    grid.insert(inserted_, voxels_, static_cast<int>(i));
    grid.refit();
  });
}

void LocalMap::shift_elevation(double angle_rad, const PoseDerivative& sensor) {
  for (PlaneGrid& grid : grids_) {
    grid.shift_elevation(angle_rad, sensor);
  }
}

void LocalMap::evict(const Eigen::Vector3d& centre) {
  for (PlaneGrid& grid : grids_) {
    grid.evict(centre, config_.radius_m);
  }
}

std::size_t LocalMap::level_of(double voxel_m) const {
  std::size_t level = finest_;
  while (level + 1 < grids_.size() && grids_[level].voxel_m() < voxel_m) {
    ++level;
  }
  return level;
}

bool LocalMap::find(const Eigen::Vector3d& p, MapPlane& plane) const {
  PlaneSpot spot;
  locate({&p, 1}, Wanted::kPlanes, finest_, &spot);
  if (spot.grid == nullptr) {
    return false;
  }
  plane = spot.grid->plane_at(spot);
  return true;
}

bool LocalMap::find_wider(const PlaneSpot& spot, PlaneSpot& wider) const {
  const std::size_t level = static_cast<std::size_t>(spot.grid - grids_.data()) + kLevelsUp;
  const VoxelIndex index{spot.index.x >> kLevelsUp, spot.index.y >> kLevelsUp, spot.index.z >> kLevelsUp};
  return level < grids_.size() && grids_[level].look_up(index, wider) == PlaneGrid::Kind::kPlane;
}

// Level by level for all points, so that the memory for the next look-up of each is prefetched during the others.
void LocalMap::locate(std::span<const Eigen::Vector3d> points, Wanted wanted, std::size_t level,
                      PlaneSpot* spots) const {
  std::array<VoxelIndex, kLookUpsInFlight> index{};
  std::array<VoxelIndex, kLookUpsInFlight> behind{};
  std::array<std::size_t, kLookUpsInFlight> open{};  // points without a plane so far
  std::array<std::size_t, kLookUpsInFlight> near{};  // those of them that lie near a face
  const bool scatter = wanted == Wanted::kPlanesAndScatter;
  std::size_t left = points.size();
  for (std::size_t i = 0; i < left; ++i) {
    open[i] = i;
    spots[i] = PlaneSpot{};
    index[i] = grids_[level].index_of(points[i]);
    grids_[level].prefetch(index[i]);
  }
  for (; level < grids_.size() && left > 0; ++level) {
    const PlaneGrid& grid = grids_[level];
    const std::size_t looked_up = std::exchange(left, 0);
    std::size_t beside = 0;
    for (std::size_t k = 0; k < looked_up; ++k) {
      const std::size_t i = open[k];
      PlaneSpot spot;
      const PlaneGrid::Kind kind = grid.look_up(index[i], spot);
      if (kind == PlaneGrid::Kind::kPlane || (scatter && kind == PlaneGrid::Kind::kScatter && !spots[i].grid)) {
        spots[i] = spot;
      }
      if (kind == PlaneGrid::Kind::kPlane) {
        continue;
      }
      if (grid.behind_face(points[i], index[i], behind[i])) {
        grid.prefetch(behind[i]);
        near[beside++] = i;
      } else {
        open[left++] = i;
      }
    }
    for (std::size_t k = 0; k < beside; ++k) {
      PlaneSpot spot;
      if (grid.look_up(behind[near[k]], spot) == PlaneGrid::Kind::kPlane) {
        spots[near[k]] = spot;
      } else {
        open[left++] = near[k];
      }
    }
    if (level + 1 == grids_.size()) {
      break;
    }
    for (std::size_t k = 0; k < left; ++k) {
      VoxelIndex& parent = index[open[k]];
      parent = {parent.x >> 1, parent.y >> 1, parent.z >> 1};  // voxels double from level to level
      grids_[level + 1].prefetch(parent);
    }
  }
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
