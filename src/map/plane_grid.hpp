// One level of the local map: voxels that keep the moments of their points and the plane through them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/pose_derivative.hpp"
#include "geometry/symmetric_eigen.hpp"
#include "geometry/voxel_key.hpp"
#include "map/chunked_pool.hpp"

namespace rilo {

/// When the points of a voxel count as a plane, and their noise.
struct PlaneCriteria {
  int min_points = 0;
  int max_points = 0;  ///< a voxel with a plane takes no more
  double max_planarity = 0.0;
  double min_extent_m = 0.0;
  double range_noise_m = 0.0;    ///< standard deviation of a point along its ray
  double angle_noise_rad = 0.0;  ///< standard deviation of its direction
  bool keep_scatter = true;      ///< points that are no plane count as a Gaussian
};

/// A point that goes into the map.
struct InsertedPoint {
  Eigen::Vector3d place;                          ///< odometry frame (m)
  Eigen::Vector3f ray = Eigen::Vector3f::Zero();  ///< from the sensor to the point, odometry frame (m)
  Eigen::Vector3f elevation_jacobian =
      Eigen::Vector3f::Zero();  ///< derivative with respect to the elevation offset (m/rad)
};

/// The voxel of a point in a grid, and how many doublings of the voxels the one of the point before lies away: with as
/// many the two share theirs. Along a beam most points in a row do.
struct InsertedVoxel {
  InsertedVoxel() = default;
  explicit InsertedVoxel(const VoxelIndex& voxel) : index(voxel) {}
  InsertedVoxel(const VoxelIndex& voxel, const VoxelIndex& before)
      : index(voxel),
        doublings_apart(static_cast<int>(std::bit_width(
            static_cast<std::uint32_t>((voxel.x ^ before.x) | (voxel.y ^ before.y) | (voxel.z ^ before.z))))) {}

  VoxelIndex index;
  int doublings_apart = std::numeric_limits<int>::max();
};

/// A surface element of the map, odometry frame.
struct MapPlane {
  Eigen::Vector3d point;   ///< centroid (m)
  Eigen::Vector3d normal;  ///< unit
  float thickness_m = 0;   ///< standard deviation along the normal
  float weight = 1;        ///< 0 … 1: squared reliability of the normal
};

/// The points of a voxel that are no surface, odometry frame: a Gaussian.
struct MapScatter {
  Eigen::Vector3d mean;       ///< m
  Eigen::Matrix3d axes;       ///< columns: unit, principal axes
  Eigen::Vector3d variances;  ///< along them (m²)
  Eigen::Vector3d bounded;    ///< 0 … 1: how much of each is the points' own extent; 0: they fill the voxel and go on
  double weight = 1;          ///< as that of a plane
};

class PlaneGrid;

/// Where a plane was found. Finding and reading are separate, so that many can be found before the first is read and
/// the memory accesses overlap. Valid until the grid changes.
struct PlaneSpot {
  const PlaneGrid* grid = nullptr;  ///< null: nothing found
  std::uint32_t voxel = 0;
  VoxelIndex index;
  bool scatter = false;  ///< not a plane: read it with scatter_at()
};

/// Voxels in a flat open-addressing hash; the voxels themselves lie in a pool. A voxel's plane is fitted on insertion,
/// when the number of its points has grown by half since the last fit, so that a look-up only reads. A look-up that
/// finds nothing touches one cache line, one that finds a plane two.
///
/// All returns of one beam lie on its cone, and points of a single cone scatter along the ray by range noise and by the
/// roughness of the surface: the plane through them contains the ray, whatever the surface. So the range noise is taken
/// off the scatter before the fit, and the reliability λ of a normal is the product of two ratios: D² / (D² + σ²), the
/// reliability ratio of a regression with errors in the variables (Fuller 1987), D the least standard deviation across
/// the rays, σ = range · angle_noise_rad; and (n·r)² of the fit over that of the regression of range on directions, the
/// two ends between which the normal lies.
class PlaneGrid {
 public:
  PlaneGrid(double voxel_m, const PlaneCriteria& criteria);

  /// Adds a point. A full voxel (criteria.max_points) with a plane takes no more, so that old surfaces do not creep
  /// with new poses; one without forgets half of its points and continues.
  void insert(const InsertedPoint& point);
  /// Adds a point of unknown ray: it counts as free of noise.
  void insert(const Eigen::Vector3d& p) { insert(InsertedPoint{p}); }

  /// Adds points in their order.
  void insert(const std::vector<InsertedPoint>& points);
  /// The same for points whose voxels are known in a grid whose voxels double so many times to those of this one.
  void insert(const std::vector<InsertedPoint>& points, const std::vector<InsertedVoxel>& voxels, int doublings);

  /// Moves all points as if the sensor's elevation angles had been larger by `angle_rad`, a small angle, relative to a
  /// sensor that moves with them by `sensor`.
  void shift_elevation(double angle_rad, const PoseDerivative& sensor);

  /// Fits the planes of the voxels touched since the last call.
  void refit();

  /// Plane of the voxel that holds `p`, or, where that has none, of the voxel behind the nearest face: a wall on the
  /// boundary of two voxels scatters over both. False when neither has one.
  bool find(const Eigen::Vector3d& p, MapPlane& plane) const;

  /// The same in two steps: where the plane is, its memory prefetched, ...
  bool locate(const Eigen::Vector3d& p, PlaneSpot& spot) const;
  /// ... and what it is.
  MapPlane plane_at(const PlaneSpot& spot) const;

  /// The points there, which are not a plane but spread in all directions.
  MapScatter scatter_at(const PlaneSpot& spot) const;
  void prefetch_scatter(const PlaneSpot& spot) const {
    __builtin_prefetch(&planes_[spot.voxel]);
    __builtin_prefetch(&extents_[spot.voxel]);
  }

  /// What the points of a voxel are.
  enum class Kind : std::uint8_t { kNone, kPlane, kScatter };

  /// The steps of locate(), for look-ups of many points whose memory accesses overlap: the voxel `index`
  /// alone, ...
  Kind look_up(const VoxelIndex& index, PlaneSpot& spot) const;
  /// ... the one behind the face near `p`, which lies in `index`; false when `p` is not near a face, ...
  bool behind_face(const Eigen::Vector3d& p, const VoxelIndex& index, VoxelIndex& behind) const;
  /// ... and the memory that look_up(index) reads first.
  void prefetch(const VoxelIndex& index) const { __builtin_prefetch(&slot_at(home_of(voxel_key(index)))); }
  VoxelIndex index_of(const Eigen::Vector3d& p) const { return voxel_of(p, inverse_); }

  /// Derivative of the place `p` on the surface there with respect to the elevation offset, m/rad, relative to a sensor
  /// that moves with it: that of the centroid, about which the surface turns as shift_elevation() turns it.
  Eigen::Vector3d elevation_jacobian_at(const PlaneSpot& spot, const Eigen::Vector3d& p,
                                        const PoseDerivative& sensor) const;

  /// Whether the voxel that holds `p` has points.
  bool occupied(const Eigen::Vector3d& p) const;

  /// Examines a slice of the voxels and drops those farther than `radius_m` from `centre`; kEvictionRounds calls
  /// examine all. All voxels must lie within 2^20 voxels of `centre`, until then of the origin: farther apart they
  /// would be taken for one another (voxel_key).
  void evict(const Eigen::Vector3d& centre, double radius_m);

  std::size_t size() const { return used_; }
  double voxel_m() const { return voxel_m_; }

  /// Appends the centroids of all voxels.
  void centroids(std::vector<Eigen::Vector3f>& out) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  static constexpr std::size_t kEvictionRounds = 32;  // about 3 s at 10 Hz: no sweep pays for the whole map

  enum class Fit : std::uint8_t { kNone, kPlane, kNoPlane };
  /// What insertion works on.
  struct alignas(16) Voxel {
    std::uint64_t key = 0;
    std::int32_t count = 0;  // 0: the place in the pool is not in use
    std::int32_t fitted_count = 0;
    Fit fit = Fit::kNone;
    // Moments about the voxel's centre, in m: single precision suffices at such short distances.
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix<float, 6, 1> squares = Eigen::Matrix<float, 6, 1>::Zero();  // xx xy xz yy yz zz
    Eigen::Vector3f elevation_jacobian_sum = Eigen::Vector3f::Zero();         // of the points
    Eigen::Vector3f ray_sum = Eigen::Vector3f::Zero();                        // of their rays

    /// Adds a point `d` from the voxel's centre.
    void add(const Eigen::Vector3f& d, const InsertedPoint& point);
    void forget_half();
    /// Turns the points about their mean, which is shifted.
    void move(const Eigen::Vector3f& shift, const Eigen::Matrix3f& R);
  };
  /// What look-ups read, at the same place in a pool of its own: half a cache line.
  struct alignas(32) Plane {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  // about the voxel's centre, at the last fit
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float thickness = 0.0F;
    float weight = 0.0F;
  };
  /// How the points extend across the normal.
  struct Extent {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();  // unit, in the plane: where the points extend less
    float middle_variance = 0.0F;                      // m², along it ...
    float large_variance = 0.0F;                       // ... and along the other direction in the plane
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t voxel = kNone;
    Kind kind = Kind::kNone;
    bool full = false;  // has a plane and takes no more points
  };
  static constexpr std::size_t kLineSlots = 4;
  struct alignas(64) SlotLine {  // a cache line
    std::array<Slot, kLineSlots> slots;
  };

  Eigen::Vector3d centre_of(const VoxelIndex& index) const {
    return voxel_m_ * Eigen::Vector3d(index.x + 0.5, index.y + 0.5, index.z + 0.5);
  }
  Eigen::Vector3d centre_of(const Voxel& voxel) const;
  /// Of the points of a voxel.
  struct Centroid {
    Eigen::Vector3d place;         // m
    Eigen::Vector3f by_elevation;  // its derivative, relative to a sensor that moves with the offset, m/rad
    Eigen::Vector3f ray;           // to it
  };
  Centroid centroid_of(const Voxel& voxel, const PoseDerivative& sensor) const;
  Slot& slot_at(std::size_t i) { return lines_[i / kLineSlots].slots[i % kLineSlots]; }
  const Slot& slot_at(std::size_t i) const { return lines_[i / kLineSlots].slots[i % kLineSlots]; }
  std::size_t last_slot() const { return lines_.size() * kLineSlots - 1; }
  /// The slot where the probe sequence of `key` begins: the four voxels of a block of 2 × 2 share a cache line, since
  /// points that are looked up one after the other lie side by side.
  std::size_t home_of(std::uint64_t key) const {
    constexpr std::uint64_t kYBit = 1ULL << 21U;
    const std::uint64_t place = (key & 1U) | ((key & kYBit) >> 20U);
    return (mix_key(key & ~(kYBit | 1U)) * kLineSlots + place) & last_slot();
  }
  /// The slot that holds `key`, or the free one that ends its probe sequence.
  std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = last_slot();
    std::size_t slot = home_of(key);
    while (slot_at(slot).voxel != kNone && slot_at(slot).key != key) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }
  /// Points in a row that share a voxel.
  struct Run {
    VoxelIndex index;
    std::uint32_t voxel = kNone;
    std::span<const InsertedPoint> points;
  };
  Slot& find_or_add(std::uint64_t key);
  void prefetch_voxel(std::uint32_t voxel) const {
    const auto* begin = reinterpret_cast<const char*>(&pool_[voxel]);
    __builtin_prefetch(begin);
    __builtin_prefetch(begin + sizeof(Voxel) - 1);  // no voxel lies in one cache line
  }
  /// The next runs of points, from the point `from` on; moves that on. Returns how many.
  std::size_t collect(std::span<const InsertedPoint> points, const std::vector<InsertedVoxel>& voxels, int doublings,
                      std::size_t& from, std::span<Run> runs) const;
  void add(const Run& run);
  void erase(std::uint32_t voxel);
  void grow();
  void fit(std::uint32_t id);
  /// Keeps what the points with the covariance `C` (m²) and the mean ray from the sensor (m) are.
  Kind keep_surface(std::uint32_t id, const Eigen::Matrix3d& C, const Eigen::Vector3d& mean_ray);
  void keep_extents(std::uint32_t id, const Eigen::Matrix3d& covariance, const SymmetricEigen3& eigen);

  double voxel_m_;
  double inverse_;
  PlaneCriteria criteria_;
  VoxelIndex place_;             // of the last eviction: keys mean the voxels around it
  std::vector<SlotLine> lines_;  // the hash table
  ChunkedPool<Voxel> pool_;
  ChunkedPool<Plane> planes_;    // of the voxels of pool_
  ChunkedPool<Extent> extents_;  // of the same
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> touched_;
  std::size_t used_ = 0;
  std::size_t eviction_cursor_ = 0;
};

}  // namespace rilo
