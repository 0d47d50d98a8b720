#include "messages.hpp"

#include <algorithm>
#include <cstddef>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2_eigen/tf2_eigen.h>

#include "rilo/io/ros_covariance.hpp"

namespace rilo::ros1 {
namespace {

template <typename Covariance>
void put(const Matrix6d& matrix, Covariance& covariance) {
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      covariance[static_cast<std::size_t>(6 * row + column)] = matrix(row, column);
    }
  }
}

geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

ros::Time to_ros_time(std::int64_t stamp_ns) {
  ros::Time time;
  return time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0)));
}

nav_msgs::Odometry odometry_message(const SweepResult& result, double step_s, const std::string& odom_frame,
                                    const std::string& base_frame) {
  nav_msgs::Odometry message;
  message.header.stamp = to_ros_time(result.stamp_ns);
  message.header.frame_id = odom_frame;
  message.child_frame_id = base_frame;
  message.pose.pose = tf2::toMsg(result.T_odom_lidar);
  put(ros_pose_covariance(result.T_odom_lidar, result.covariance), message.pose.covariance);
  message.twist.twist.angular = to_vector(result.twist.head<3>());
  message.twist.twist.linear = to_vector(result.twist.tail<3>());
  put(ros_twist_covariance(result.covariance, step_s), message.twist.covariance);
  return message;
}

geometry_msgs::TransformStamped transform_message(const SweepResult& result, bool inverted,
                                                  const std::string& odom_frame, const std::string& base_frame) {
  geometry_msgs::TransformStamped message =
      tf2::eigenToTransform(inverted ? result.T_odom_lidar.inverse() : result.T_odom_lidar);
  message.header.stamp = to_ros_time(result.stamp_ns);
  message.header.frame_id = inverted ? base_frame : odom_frame;
  message.child_frame_id = inverted ? odom_frame : base_frame;
  return message;
}

nav_msgs::Path path_message(const Trajectory& trajectory, const std::string& odom_frame) {
  nav_msgs::Path message;
  message.header.frame_id = odom_frame;
  message.poses.reserve(trajectory.size());
  for (const auto& [stamp_ns, T] : trajectory) {
    geometry_msgs::PoseStamped& pose = message.poses.emplace_back();
    pose.header.stamp = to_ros_time(stamp_ns);
    pose.header.frame_id = odom_frame;
    pose.pose = tf2::toMsg(T);
  }
  if (!message.poses.empty()) message.header.stamp = message.poses.back().header.stamp;
  return message;
}

sensor_msgs::PointCloud2 cloud_message(const std::vector<Eigen::Vector3f>& points, std::int64_t stamp_ns,
                                       const std::string& frame) {
  sensor_msgs::PointCloud2 message;
  message.header.stamp = to_ros_time(stamp_ns);
  message.header.frame_id = frame;
  message.is_dense = 1U;
  sensor_msgs::PointCloud2Modifier modifier(message);
  modifier.setPointCloud2Fields(3, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1, sensor_msgs::PointField::FLOAT32,
                                "z", 1, sensor_msgs::PointField::FLOAT32);
  modifier.resize(points.size());
  sensor_msgs::PointCloud2Iterator<float> value(message, "x");
  for (const Eigen::Vector3f& point : points) {
    value[0] = point.x();
    value[1] = point.y();
    value[2] = point.z();
    ++value;
  }
  return message;
}

}  // namespace rilo::ros1
