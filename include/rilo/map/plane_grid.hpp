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
  /// How the centroid moves with the sensor's elevation angles, m/rad: mean over its points.
  Eigen::Vector3f elevation_lever = Eigen::Vector3f::Zero();
};

/// Voxels in a flat open-addressing hash; the voxels themselves lie in a pool. A voxel's plane is fitted on insertion,
/// when the number of its points has grown by half since the last fit, so that a look-up only reads.
class PlaneGrid {
 public:
  PlaneGrid(double voxel_m, const PlaneCriteria& criteria);

  /// Adds a point. `elevation_lever`: how it moves with the sensor's elevation angles (m/rad).
  void insert(const Eigen::Vector3d& p, const Eigen::Vector3f& elevation_lever = Eigen::Vector3f::Zero());

  /// Moves all points as if the sensor's elevation angles had been larger by `angle_rad`, a small angle, seen from a
  /// sensor that moves with them.
  void turn_elevation(double angle_rad, const RigidLever& sensor);

  /// Fits the planes of the voxels touched since the last call.
  void refit();

  /// Plane of the voxel that holds `p`, or, where that has none, of the voxel behind the nearest face: a wall on the
  /// boundary of two voxels scatters over both. False when neither has one.
  bool find(const Eigen::Vector3d& p, MapPlane& plane) const;

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

  struct Voxel {
    std::uint64_t key = 0;
    VoxelIndex index;
    std::int32_t count = 0;
    std::int32_t fitted_count = 0;
    // Moments about the voxel's centre, in m: single precision is exact enough because the lever is short.
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix<float, 6, 1> squares = Eigen::Matrix<float, 6, 1>::Zero();  // xx xy xz yy yz zz
    Eigen::Vector3f lever_sum = Eigen::Vector3f::Zero();                      // of the points' elevation levers
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();                           // at the last fit
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float thickness = -1.0F;  // negative: no plane
    bool free = true;         // the place in the pool is not in use
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t voxel = kNone;
  };

  bool plane_of(const VoxelIndex& index, MapPlane& plane) const;
  Eigen::Vector3d centre_of(const VoxelIndex& index) const;
  std::uint32_t find_voxel(std::uint64_t key) const;
  std::uint32_t find_or_add(const VoxelIndex& index);
  void erase(std::uint32_t voxel);
  void grow();
  void fit(Voxel& voxel) const;

  double voxel_m_;
  double inverse_;
  PlaneCriteria criteria_;
  std::vector<Slot> slots_;
  std::vector<Voxel> pool_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> touched_;
  std::size_t used_ = 0;
  std::size_t eviction_cursor_ = 0;
};

}  // namespace rilo
