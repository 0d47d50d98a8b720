// How sharp is the map that a trajectory builds? A figure that needs no ground truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "rilo/evaluation/pose_error.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// What is looked at. Compare trajectories on the same sweeps with the same numbers only.
struct MapQualityConfig {
  std::size_t window_sweeps = 30;         ///< consecutive sweeps of one map; the next map begins half a window later
  std::size_t sweep_step = 3;             ///< sweeps 0, 3, 6 … of a window go into its map
  double min_range_m = 3;                 ///< points nearer to the sensor are dropped
  double max_range_m = 40;                ///< and points farther away
  double voxel_m = 0;                     ///< keeps one point per sweep and voxel of this size; 0: all
  std::size_t points_per_sweep = 40000;   ///< at most, chosen at random
  std::size_t samples_per_window = 3000;  ///< places that are looked at: points of the window's first sweep
  double radius_m = 0.3;                  ///< of the neighbourhood of such a place
  std::size_t min_neighbours = 25;        ///< places with fewer neighbours do not count,
  std::size_t min_sweeps = 5;             ///< nor those whose neighbours are of fewer sweeps
  double max_planar_ratio = 0.1;  ///< planar: smallest eigenvalue of the covariance below this share of the middle one
  std::uint64_t seed = 1;         ///< of the random choice, which depends on the sweeps, not on the poses
  int threads = 0;                ///< 0: as many as the machine has; the result does not depend on it
};

/// Smaller is sharper. Differences below about 1 % are noise of the choice of places.
/// Wrong poses lose planes, the thick ones first: what is left can be thinner than the right poses' planes. So the
/// figures of the planar places are compared at about equal planar_share only; bounded_rms_m does not gain by a lost
/// plane. All of them gain by a path that is too short where most is open ground: `places` then differ, too.
struct MapQuality {
  std::size_t sweeps = 0;
  std::size_t windows = 0;
  std::size_t samples = 0;                 ///< places that were looked at
  std::size_t places = 0;                  ///< that counted
  double planar_share = 0;                 ///< of the samples
  double bounded_rms_m = 0;                ///< mean over all samples; one without a plane counts as no_plane_m()
  ErrorSummary plane_rms_m;                ///< root mean square distance to the local plane, over the planar places
  double plane_rms_p75_m = 0;              ///< its 75th percentile (linear, as numpy's); 0 without planar places
  std::optional<double> mean_map_entropy;  ///< mean of ½ ln det(2πe C) over the places, C in m²; empty without places
};

/// The thickness where an evenly filled disc of radius_m is planar no more; no sample counts more.
double no_plane_m(const MapQualityConfig& config);

/// Takes sweeps one after the other; keeps at most one window of them.
/// C is the covariance (N − 1) of the neighbours of a place within radius_m in the map of the window, eigenvalues
/// not below 1e-12 m²; its smallest eigenvalue is the mean square distance to the local plane.
class MapQualityMeter {
 public:
  /// @throws std::invalid_argument when the configuration makes no sense.
  explicit MapQualityMeter(const MapQualityConfig& config);

  /// Adds the next sweep: `points` in the sensor frame at the time of the pose (m); those that are not finite are
  /// dropped. @throws std::invalid_argument when the pose is not finite.
  void add(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar);

  /// Of all windows that are complete.
  MapQuality result() const;

 private:
  struct Kept {
    std::size_t number = 0;               // of the sweep, from 0
    std::vector<Eigen::Vector3d> points;  // sensor frame, in random order
    SE3 T_odom_lidar = SE3::Identity();
  };
  bool needed(std::size_t number) const;
  Kept thinned(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_lidar) const;
  void measure(std::size_t first);

  MapQualityConfig config_;
  std::size_t window_step_;
  std::size_t sweeps_ = 0;
  std::size_t windows_ = 0;
  std::size_t samples_ = 0;
  std::deque<Kept> kept_;
  std::vector<double> entropies_;
  std::vector<double> plane_rms_m_;
};

/// The same for sweeps in memory; pose i belongs to sweep i.
/// @throws std::invalid_argument also when there are not as many poses as sweeps.
MapQuality map_quality(const std::vector<std::vector<Eigen::Vector3f>>& sweeps, const std::vector<SE3>& T_odom_lidar,
                       const MapQualityConfig& config = {});

}  // namespace rilo
