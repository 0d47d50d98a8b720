// The local map of the odometry, and how sweeps go into it.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"

namespace rilo {

/// A map of fewer sweeps explains less of a sweep than usual, and the prediction needs two motions.
inline constexpr std::size_t kEstablishedSweeps = 3;

/// Local map with the number of its sweeps. The velocity of its first sweep is unknown and taken as given: once the
/// second sweep shows it, first_compensated() is the map as it should have begun.
class SweepMap {
 public:
  explicit SweepMap(const LocalMapConfig& config) : config_(config), map_(config) {}

  const LocalMap& map() const { return map_; }
  LocalMap& map() { return map_; }
  std::size_t sweeps() const { return sweeps_; }
  /// The points that went in last, motion-compensated, sensor frame, and their intensities.
  const std::vector<Eigen::Vector3f>& last_points() const { return points_; }
  const std::vector<float>& last_intensities() const { return intensities_; }

  /// Drops the map and begins with a sweep.
  void begin(const TimedCloud& cloud, const MotionState& state, double scene_range_m,
             const PoseDerivative& pose_by_elevation);
  void insert(const TimedCloud& cloud, const MotionState& state, const PoseDerivative& pose_by_elevation);

  /// Whether the only sweep so far carries the times that it takes to compensate it.
  bool first_can_be_compensated() const { return sweeps_ == 1 && first_cloud_.timed(); }
  /// Leaves a share of the points of that sweep.
  void thin_first(double share);
  const TimedCloud& first_cloud() const { return first_cloud_; }
  /// The map of the first sweep alone, compensated for `twist`; `first`: its points, or some of them.
  LocalMap first_compensated(const TimedCloud& first, const Vector6d& twist, double scene_range_m,
                             const PoseDerivative& pose_by_elevation) const;
  /// A map of one sweep alone.
  LocalMap of_sweep(const TimedCloud& cloud, const MotionState& state, double scene_range_m,
                    const PoseDerivative& pose_by_elevation) const;
  void replace(LocalMap map) { map_ = std::move(map); }

  void clear();

 private:
  LocalMapConfig config_;
  LocalMap map_;
  std::size_t sweeps_ = 0;
  TimedCloud first_cloud_;
  SE3 T_odom_first_ = SE3::Identity();
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> intensities_;
};

}  // namespace rilo
