// nav_msgs/Odometry and tf2_msgs/TFMessage of a sweep, in the order of their fields, which both ROS share.
#pragma once

#include <span>

#include "io/ros/ros_values.hpp"
#include "io/stamp_difference.hpp"
#include "io/unit_quaternion.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {

template <typename Bytes>
void put_vector(Bytes& bytes, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) bytes.put(value);
}

template <typename Bytes>
void put_covariance(Bytes& bytes, const Matrix6d& covariance) {
  for (const double value : covariance.reshaped<Eigen::RowMajor>()) bytes.put(value);
}

/// Header, child_frame_id, and where the sensor is: the beginning of both messages.
template <typename Bytes>
void put_stamped_pose(Bytes& bytes, const SweepResult& result, const RecordingNames& names) {
  bytes.put_stamp(result.stamp_ns);
  bytes.put_text(names.odom_frame);
  bytes.put_text(names.lidar_frame);
  put_vector(bytes, result.T_odom_lidar.translation());
  const Eigen::Quaterniond q = unit_quaternion(result.T_odom_lidar);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) bytes.put(value);
}

/// Odometry of results[i]; its velocity covers the step from the pose before it.
template <typename Bytes>
void put_odometry(Bytes& bytes, std::span<const SweepResult> results, std::size_t i, const RecordingNames& names) {
  const SweepResult& result = results[i];
  const std::int64_t step_ns = i == 0 ? 0 : stamp_difference(result.stamp_ns, results[i - 1].stamp_ns);
  put_stamped_pose(bytes, result, names);
  put_covariance(bytes, ros_pose_covariance(result.T_odom_lidar, result.covariance));
  put_vector(bytes, result.twist.tail<3>());
  put_vector(bytes, result.twist.head<3>());
  put_covariance(bytes, ros_twist_covariance(result.covariance, static_cast<double>(step_ns) * 1e-9));
}

/// A TFMessage of one transform.
template <typename Bytes>
void put_transform(Bytes& bytes, const SweepResult& result, const RecordingNames& names) {
  bytes.put(std::uint32_t{1});
  put_stamped_pose(bytes, result, names);
}

}  // namespace rilo::detail
