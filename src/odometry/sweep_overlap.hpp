// How much two sweeps see in common under a motion between them.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"

namespace rilo {

/// Compares a sweep with the one before where no motion is known. A registration weights what the sensor sees densely:
/// the road, and cars of the sensor's own pace. Here each cubic metre counts once, so that what is spread over the
/// surroundings decides.
class SweepOverlap {
 public:
  /// Width of a match; places half as far apart and nearer are hardly told apart.
  static constexpr double kSigmaM = 0.25;

  /// A sweep and the planes of it alone.
  struct Seen {
    const TimedCloud& cloud;  ///< m, sensor frame, with times
    MotionState state;
    const LocalMap& planes;  ///< in that state
  };

  /// `direction`: unit, odometry frame. Planes along it look alike wherever they are moved along it: their points are
  /// left out.
  SweepOverlap(const Seen& before, const Seen& sweep, const Eigen::Vector3d& direction);

  /// For each place that the sweep sees exp(−d²/2σ²), d the distance to the nearest point of the sweep before, were
  /// this the sweep's state and `twist_before` the velocity of the one before: 0 … 1.
  std::vector<double> matches(const MotionState& state, const Vector6d& twist_before) const;

  /// Mean of that; 0 when there are no places.
  double at(const MotionState& state, const Vector6d& twist_before) const;

 private:
  SE3 T_odom_before_;
  TimedCloud before_;
  TimedCloud places_;
};

}  // namespace rilo
