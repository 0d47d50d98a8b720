#include "odometry/sweep_map.hpp"

#include "cloud/deskew.hpp"
#include "cloud/thinning.hpp"

namespace rilo {

void SweepMap::begin(const TimedCloud& cloud, const MotionState& state, double scene_range_m,
                     const PoseDerivative& pose_by_elevation) {
  map_.clear();
  map_.set_scene_range(scene_range_m);
  sweeps_ = 0;
  first_cloud_ = cloud;
  T_odom_first_ = state.T_odom_lidar;
  insert(cloud, state, pose_by_elevation);
}

void SweepMap::insert(const TimedCloud& cloud, const MotionState& state, const PoseDerivative& pose_by_elevation) {
  deskew(cloud, state.motion(), points_);
  intensities_ = cloud.intensities;
  map_.insert(points_, state.T_odom_lidar, pose_by_elevation);
  map_.evict(state.T_odom_lidar.translation());
  ++sweeps_;
}

void SweepMap::thin_first(double share) { first_cloud_ = thinned(first_cloud_, share); }

LocalMap SweepMap::first_compensated(const TimedCloud& first, const Vector6d& twist, double scene_range_m,
                                     const PoseDerivative& pose_by_elevation) const {
  return of_sweep(first, {T_odom_first_, twist}, scene_range_m, pose_by_elevation);
}

LocalMap SweepMap::of_sweep(const TimedCloud& cloud, const MotionState& state, double scene_range_m,
                            const PoseDerivative& pose_by_elevation) const {
  LocalMap map(config_);
  map.set_scene_range(scene_range_m);
  std::vector<Eigen::Vector3f> points;
  deskew(cloud, state.motion(), points);
  map.insert(points, state.T_odom_lidar, pose_by_elevation);
  return map;
}

void SweepMap::clear() { *this = SweepMap(config_); }

}  // namespace rilo
