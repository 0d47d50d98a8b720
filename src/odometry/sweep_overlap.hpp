// How much two sweeps see in common under a motion between them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cloud/deskew.hpp"
#include "cloud/point_grid.hpp"
#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"

namespace rilo {

/// Mean of the matches; 0 when there are none.
double mean_match(std::span<const double> matches);

/// Compares a sweep with the one before where the motion between them is in doubt. A registration weights what the
/// sensor sees densely: the road, and cars of the sensor's own pace. Here each cubic metre counts once, so that what is
/// spread over the surroundings decides.
class SweepOverlap {
 public:
  /// Width of a match; places half as far apart and nearer are hardly told apart.
  static constexpr double kSigmaM = 0.25;
  /// Sweeps that are taken farther apart share too little.
  static constexpr double kReachM = 40.0;

  /// A sweep and the planes around it.
  struct Seen {
    const TimedCloud& cloud;  ///< m, sensor frame, with times
    MotionState state;
    const LocalMap& planes;  ///< in that state
  };

  SweepOverlap(const Seen& before, const Seen& sweep);

  /// From now on only what shows `motion` is compared, a twist of the sensor, axes of the odometry frame, of any
  /// length. Planes that it moves along themselves look alike wherever they are moved by it: their points are left out.
  void look_along(const Vector6d& motion);

  /// The sweep before, compensated for its motion.
  PointGrid before(const BodyMotion& motion) const;

  /// For each place that the sweep sees exp(−d²/2σ²), d the distance to the nearest point of `before`, were this the
  /// sweep's state: 0 … 1.
  std::vector<double> matches(const MotionState& state, const PointGrid& before) const;

  double at(const MotionState& state, const PointGrid& before) const { return mean_match(matches(state, before)); }

 private:
  /// One point a voxel, of those that lie on a surface.
  struct Surfaces {
    TimedCloud cloud;
    std::vector<Eigen::Vector3d> from_sensor;  // axes of the odometry frame
    std::vector<Eigen::Vector3d> normals;      // 0: of no plane
  };
  static Surfaces surfaces_of(const Seen& seen, double voxel_m);
  static TimedCloud telling(const Surfaces& surfaces, const Vector6d& motion);

  SE3 T_odom_before_;
  Surfaces seen_before_;
  Surfaces seen_;
  TimedCloud before_;
  TimedCloud places_;
};

/// Overlaps at `count` places, looked at in parallel until it is `late`; 0 for those that were not.
std::vector<double> overlaps_of(std::size_t count, const std::function<double(std::size_t)>& overlap_at,
                                const std::function<bool()>& late);

/// The same of places a sigma apart in a row: every second one, between which a match is still 0.6, then those beside
/// the best of them. 0 for the others.
std::vector<double> overlaps_along(std::size_t count, const std::function<double(std::size_t)>& overlap_at,
                                   const std::function<bool()>& late);

/// Index of the most overlap, of the first of equal ones. There must be one.
std::size_t most_of(const std::vector<double>& overlaps);
/// The same of those that are allowed; none may be.
std::optional<std::size_t> most_of(const std::vector<double>& overlaps,
                                   const std::function<bool(std::size_t)>& allowed);

/// Whether the matches `most` exceed those of the same places under another motion: by three standard deviations of
/// their difference, were the places independent, and by more than `times` what the others exceed them by, since places
/// that move together, as cars of one pace do, are not.
bool clearly_more(std::span<const double> most, std::span<const double> others, double times = 2.0);

}  // namespace rilo
