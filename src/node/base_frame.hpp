// From the LiDAR's poses to those of the robot's base.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// A frame as tf2 knows it: ROS 1's old drivers write names with a slash in front, which it does not look up.
std::string frame_name(std::string name);

/// Pose of the base where the LiDAR is at T_odom_lidar from where it began; `T_world_odom` is put before it.
SE3 base_pose(const SE3& T_odom_lidar, const SE3& T_base_lidar, const SE3& T_world_odom);

/// `result` of the LiDAR as one of the base: T_odom_lidar is its base_pose(), twist and covariance are the base's own.
SweepResult of_base(const SweepResult& result, const SE3& T_base_lidar, const SE3& T_world_odom);

/// `points` seen from another frame.
void transform_points(const SE3& T, std::vector<Eigen::Vector3f>& points);

}  // namespace rilo
