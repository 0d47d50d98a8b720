// The local map: surface elements around the sensor at several voxel sizes.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "map/plane_grid.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Voxel map with a plane per voxel. Thread-safe to read from many threads; changing it needs it alone.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapConfig& config);

  /// Sets the finest level that insert and find use from now on, from the size of the place (typical range of a point,
  /// m): small rooms need small voxels, and in the open small voxels hold too few points of too few beams.
  void set_scene_range(double range_m);

  /// Adds points of the sensor frame at the pose `T_odom_lidar`, then fits the planes that changed.
  /// `pose_by_elevation`: derivative of that pose with respect to the elevation offset, for shift_elevation().
  void insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar,
              const PoseDerivative& pose_by_elevation = {});

  /// Moves all voxels as if the sensor's elevation angles had been larger by `angle_rad`, a small angle, relative to a
  /// sensor that moves with them by `sensor`.
  void shift_elevation(double angle_rad, const PoseDerivative& sensor);

  /// Drops voxels far from `centre` (odometry frame), a slice per call.
  void evict(const Eigen::Vector3d& centre);

  /// Surface element at `p` (odometry frame): the finest level with a plane there. False when there is none.
  bool find(const Eigen::Vector3d& p, MapPlane& plane) const;

  /// The plane of the voxel two levels up, four times as wide, around that of `spot`. False when there is none.
  bool find_wider(const PlaneSpot& spot, PlaneSpot& wider) const;

  /// What a look-up of many points looks for.
  enum class Wanted { kPlanes, kPlanesAndScatter };

  /// The finest level of those in use whose voxels are no smaller than `voxel_m`; else the coarsest.
  std::size_t level_of(double voxel_m) const;

  /// find() for many points: calls use(k, p, spot) with p = point_at(k) (odometry frame) for each k = first … last − 1,
  /// in order, that meets a surface element (or, if wanted, a voxel that is not a plane). Look-ups run in batches: one
  /// by one they would wait for memory most of the time. They begin at the finest level in use or at `level`.
  template <Wanted What = Wanted::kPlanes, typename PointAt, typename Use>
  void visit(std::size_t first, std::size_t last, const PointAt& point_at, const Use& use,
             std::size_t level = 0) const {
    std::array<Eigen::Vector3d, kLookUpsInFlight> points;
    std::array<PlaneSpot, kLookUpsInFlight> spots;
    for (std::size_t begin = first; begin < last; begin += kLookUpsInFlight) {
      const std::size_t n = std::min(kLookUpsInFlight, last - begin);
      for (std::size_t i = 0; i < n; ++i) {
        points[i] = point_at(begin + i);
      }
      locate({points.data(), n}, What, std::max(level, finest_), spots.data());
      for (std::size_t i = 0; i < n; ++i) {
        if (spots[i].grid != nullptr) {
          use(begin + i, points[i], spots[i]);
        }
      }
    }
  }

  /// The finest voxel that a look-up at `p` looks into.
  VoxelIndex finest_voxel(const Eigen::Vector3d& p) const { return grids_[finest_].index_of(p); }

  /// Voxels of all levels.
  std::size_t size() const;

  /// One point per voxel, from the finest level that has points there: the centroid of its points (odometry frame, m).
  std::vector<Eigen::Vector3f> points() const;

  void clear();

 private:
  /// The finest plane from `level` on at each of at most kLookUpsInFlight points, or, where there is none and it is
  /// wanted, the finest points that are not a plane; an empty spot where there is neither.
  void locate(std::span<const Eigen::Vector3d> points, Wanted wanted, std::size_t level, PlaneSpot* spots) const;

  LocalMapConfig config_;
  std::vector<PlaneGrid> grids_;  // finest first
  std::size_t finest_ = 0;
  std::vector<InsertedPoint> inserted_;  // the points being inserted ...
  std::vector<InsertedVoxel> voxels_;    // ... and their voxels at the finest level in use
};

}  // namespace rilo
