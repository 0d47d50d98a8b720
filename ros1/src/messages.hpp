// What the odometry says, as ROS messages.
#pragma once

#include <cstdint>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo::ros1 {

/// ROS knows no time before 1970: that becomes 0.
ros::Time to_ros_time(std::int64_t stamp_ns);

/// Pose in odom_frame with the covariance given the pose before; velocity in base_frame, its covariance that of the
/// pose over `step_s`, the time since the pose before (0: there is none, the velocity is unknown).
nav_msgs::Odometry odometry_message(const SweepResult& result, double step_s, const std::string& odom_frame,
                                    const std::string& base_frame);

/// odom_frame → base_frame, or the inverse: base_frame → odom_frame.
geometry_msgs::TransformStamped transform_message(const SweepResult& result, bool inverted,
                                                  const std::string& odom_frame, const std::string& base_frame);

nav_msgs::Path path_message(const Trajectory& trajectory, const std::string& odom_frame);

/// x, y, z as float32.
sensor_msgs::PointCloud2 cloud_message(const std::vector<Eigen::Vector3f>& points, std::int64_t stamp_ns,
                                       const std::string& frame);

}  // namespace rilo::ros1
