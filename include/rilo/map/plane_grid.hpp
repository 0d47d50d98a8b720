// One level of the local map: voxels that keep the moments of their points and the plane through them.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/voxel_key.hpp"
#include "rilo/map/rigid_lever.hpp"

namespace rilo {

/// When a voxel's points count as a plane.
struct PlaneCriteria {
  int min_points = 6;
  int max_points = 100;
  double max_planarity = 0.1;
  double min_extent_m = 0.05;
};

/// A surface element of the map, odometry frame.
struct MapPlane {
  Eigen::Vector3d point;   ///< centroid (m)
  Eigen::Vector3d normal;  ///< unit
  float thickness_m = 0;   ///< standard deviation along the normal
};

class PlaneGrid;

/// Where a plane was found. Finding and reading are apart, so that many can be found before the first is read: the
/// memory then answers to all at once. Valid until the grid changes.
struct PlaneSpot {
  const PlaneGrid* grid = nullptr;  ///< null: no plane there
  std::uint32_t voxel = 0;
  VoxelIndex index;
};

/// Voxels in a flat open-addressing hash; the voxels themselves lie in a pool. A voxel's plane is fitted on insertion,
/// when the number of its points has grown by half since the last fit, so that a look-up only reads. A look-up that
/// finds nothing touches one cache line, one that finds a plane two.
class PlaneGrid {
 public:
  PlaneGrid(double voxel_m, const PlaneCriteria& criteria);

  /// Adds a point. `elevation_lever`: how it moves with the sensor's elevation angles (m/rad).
  void insert(const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever = Eigen::Vector3f::Zero());

  /// Adds points in their order; as many levers as points.
  void insert(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3f>& elevation_levers);

  /// Moves all points as if the sensor's elevation angles had been larger by `angle_rad`, a small angle, seen from a
  /// sensor that moves with them.
  void turn_elevation(double angle_rad, const RigidLever& sensor);

  /// Fits the planes of the voxels touched since the last call.
  void refit();

  /// Plane of the voxel that holds `p`, or, where that has none, of the voxel behind the nearest face: a wall on the
  /// boundary of two voxels scatters over both. False when neither has one.
  bool find(const Eigen::Vector3d& p, MapPlane& plane) const;

  /// The same in two steps: where the plane is, its memory already asked for, ...
  bool locate(const Eigen::Vector3d& p, PlaneSpot& spot) const;
  /// ... and what it is.
  MapPlane plane_at(const PlaneSpot& spot) const;

  /// Asks for the memory that locate(p) will read first.
  void prefetch(const Eigen::Vector3d& p) const {
    __builtin_prefetch(&slots_[mix_key(voxel_key(voxel_of(p, inverse_))) & (slots_.size() - 1)]);
  }

  /// How the centroid of the points there moves with the sensor's elevation angles, m/rad: mean over its points.
  Eigen::Vector3f elevation_lever_at(const PlaneSpot& spot) const {
    const Voxel& voxel = pool_[spot.voxel];
    return voxel.lever_sum / static_cast<float>(voxel.count);
  }

  /// Whether the voxel that holds `p` has points.
  bool occupied(const Eigen::Vector3d& p) const;

  /// Examines a slice of the voxels and drops those farther than `radius_m` from `centre`. A full round takes
  /// kEvictionRounds calls.
  void evict(const Eigen::Vector3d& centre, double radius_m);

  std::size_t size() const { return used_; }
  double voxel_m() const { return voxel_m_; }

  /// Appends the centroids of all voxels.
  void centroids(std::vector<Eigen::Vector3f>& out) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  static constexpr std::size_t kEvictionRounds = 32;

  /// What insertion works on: a cache line.
  struct alignas(64) Voxel {
    std::uint64_t key = 0;
    std::int32_t count = 0;  // 0: the place in the pool is not in use
    std::int32_t fitted_count = 0;
    // Moments about the voxel's centre, in m: single precision is exact enough because the lever is short.
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix<float, 6, 1> squares = Eigen::Matrix<float, 6, 1>::Zero();  // xx xy xz yy yz zz
    Eigen::Vector3f lever_sum = Eigen::Vector3f::Zero();                      // of the points' elevation levers
  };
  /// What look-ups read, at the same place in a pool of its own: half a cache line.
  struct alignas(32) Plane {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  // about the voxel's centre, at the last fit
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float thickness = 0.0F;
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t voxel = kNone;
    std::uint32_t planar = 0;  // whether the voxel has a plane
  };

  Eigen::Vector3d centre_of(const VoxelIndex& index) const;
  std::size_t slot_of(std::uint64_t key) const;
  bool plane_in(const VoxelIndex& index, PlaneSpot& spot) const;
  std::uint32_t find_or_add(std::uint64_t key);
  void add(std::uint32_t id, const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever);
  void erase(std::uint32_t voxel);
  void grow();
  void fit(std::uint32_t id);

  double voxel_m_;
  double inverse_;
  PlaneCriteria criteria_;
  std::vector<Slot> slots_;
  std::vector<Voxel> pool_;
  std::vector<Plane> planes_;  // of the voxels of pool_
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> touched_;
  std::size_t used_ = 0;
  std::size_t eviction_cursor_ = 0;
};

}  // namespace rilo
