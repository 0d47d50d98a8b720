#include "rilo/session/session_observer.hpp"

namespace rilo {

void MapObserver::on_registered(const RegisteredSweep& sweep) {
  if (!belongs_in_map(sweep.result.status, !sweep.sweep.times_s.empty())) return;
  map_.add(sweep.odometry.last_map_points(), sweep.result.T_odom_lidar, sweep.odometry.last_map_intensities());
}

void MapObserver::on_restart(const Restart& /*restart*/) { map_ = ThinnedMap(voxel_m_); }

void MapObserver::on_end(const Odometry& odometry) {
  if (map_.size() == 0) local_ = odometry.local_map();
}

MapCloud MapObserver::cloud(bool with_normals) const {
  if (map_.size() > 0) return map_.cloud(with_normals);
  MapCloud cloud;
  cloud.points = local_;
  return cloud;
}

}  // namespace rilo
