// A trajectory: stamped poses of the sensor.
#pragma once

#include <cstdint>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Pose of the LiDAR in the odometry frame at one time.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  SE3 T_odom_lidar = SE3::Identity();
};

using Trajectory = std::vector<StampedPose>;

}  // namespace rilo
