// A user's program: two sweeps of a room, the sensor half a metre further along it in the second.
#include <cstdint>
#include <cstdio>

#include "rilo/rilo.hpp"

#ifdef RUN_RECORDING
int run_recording_of_a_room(const rilo::Sweep& first, const rilo::Sweep& second);
#endif

namespace {

// Points on the walls and the floor of the room, seen from `x` metres along it.
rilo::Sweep room_seen_from(float x, std::int64_t stamp_ns) {
  rilo::Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  for (float along = -12.0F; along <= 12.0F; along += 0.1F) {
    for (float z = -1.6F; z <= 3.0F; z += 0.1F) {
      sweep.points.emplace_back(along - x, 7.13F, z);
      sweep.points.emplace_back(along - x, -6.21F, z);
      sweep.points.emplace_back(12.17F - x, along / 2, z);
      sweep.points.emplace_back(-12.33F - x, along / 2, z);
    }
    for (float y = -6.2F; y <= 7.1F; y += 0.1F) {
      sweep.points.emplace_back(along - x, y, -1.68F);
    }
  }
  return sweep;
}

}  // namespace

int main() {
#ifdef RUN_RECORDING
  return run_recording_of_a_room(room_seen_from(0.0F, 0), room_seen_from(0.5F, 100'000'000));
#endif
  rilo::Odometry odometry{rilo::OdometryConfig{}};
  odometry.register_sweep(room_seen_from(0.0F, 0));
  const rilo::SweepResult result = odometry.register_sweep(room_seen_from(0.5F, 100'000'000));
  const Eigen::Vector3d moved = result.T_odom_lidar.translation();
  std::printf("moved %.3f %.3f %.3f m, %zu points in the map\n", moved.x(), moved.y(), moved.z(),
              odometry.local_map().size());
  const bool right = (moved - Eigen::Vector3d(0.5, 0.0, 0.0)).norm() < 0.1 && odometry.trajectory().size() == 2;
  return right ? 0 : 1;
}
