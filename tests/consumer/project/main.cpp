// A user's program: two sweeps of a box-shaped room, the sensor half a metre further in the second.
#include <cmath>
#include <cstdio>

#include "rilo/odometry/odometry.hpp"

namespace {

// Points on the walls and the floor of a room, seen from `x` metres along it.
rilo::Sweep room_seen_from(float x, std::int64_t stamp_ns) {
  rilo::Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  for (float along = -12.0F; along <= 12.0F; along += 0.2F) {
    for (float z = -1.5F; z <= 3.0F; z += 0.3F) {
      sweep.points.insert(sweep.points.end(), {{along - x, 7.0F, z}, {along - x, -6.0F, z}});
      sweep.points.insert(sweep.points.end(), {{12.0F - x, along / 2, z}, {-12.0F - x, along / 2, z}});
    }
    for (float y = -6.0F; y <= 7.0F; y += 0.5F) sweep.points.emplace_back(along - x, y, -1.5F);
  }
  return sweep;
}

}  // namespace

int main() {
  rilo::Odometry odometry{rilo::OdometryConfig{}};
  odometry.register_sweep(room_seen_from(0.0F, 0));
  const rilo::SweepResult result = odometry.register_sweep(room_seen_from(0.5F, 100'000'000));
  const Eigen::Vector3d moved = result.T_odom_lidar.translation();
  std::printf("moved %.3f %.3f %.3f m, %zu points in the map\n", moved.x(), moved.y(), moved.z(),
              odometry.local_map().size());
  const bool right = (moved - Eigen::Vector3d(0.5, 0.0, 0.0)).norm() < 0.05 && odometry.trajectory().size() == 2;
  return right ? 0 : 1;
}
