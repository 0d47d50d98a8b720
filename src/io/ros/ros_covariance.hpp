// The covariance of a pose as ROS writes it.
#pragma once

#include "rilo/odometry/sweep_result.hpp"

namespace rilo::detail {

/// Row and column order x, y, z, roll, pitch, yaw, about the axes of the odometry frame (m², m·rad, rad²).
Matrix6d ros_covariance(const SweepResult& result);

}  // namespace rilo::detail
