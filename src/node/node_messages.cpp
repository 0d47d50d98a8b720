#include "rilo/node/node_messages.hpp"

#include <cstring>

#include "io/ros/ros_values.hpp"
#include "io/unit_quaternion.hpp"

namespace rilo {
namespace {

PoseMessage pose_message(const SE3& T) { return {T.translation(), detail::unit_quaternion(T)}; }

std::array<double, 36> rows_of(const Matrix6d& matrix) {
  std::array<double, 36> rows{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data()) = matrix;
  return rows;
}

}  // namespace

NodeStamp node_stamp(std::int64_t stamp_ns) {
  const detail::MessageStamp stamp = detail::message_stamp(stamp_ns, 0, detail::kLastRos2Second);
  return {stamp.seconds, stamp.nanoseconds};
}

OdometryMessage odometry_message(const SweepResult& result, double step_s, const std::string& odom_frame,
                                 const std::string& base_frame) {
  return {node_stamp(result.stamp_ns),
          odom_frame,
          base_frame,
          pose_message(result.T_odom_lidar),
          rows_of(ros_pose_covariance(result.T_odom_lidar, result.covariance)),
          result.twist.tail<3>(),
          result.twist.head<3>(),
          rows_of(ros_twist_covariance(result.covariance, step_s))};
}

TransformMessage transform_message(const SweepResult& result, bool inverted, const std::string& odom_frame,
                                   const std::string& base_frame) {
  return {node_stamp(result.stamp_ns), inverted ? base_frame : odom_frame, inverted ? odom_frame : base_frame,
          pose_message(inverted ? result.T_odom_lidar.inverse() : result.T_odom_lidar)};
}

PathMessage path_message(const Trajectory& trajectory, const std::string& odom_frame) {
  PathMessage message{{}, odom_frame, {}};
  message.poses.reserve(trajectory.size());
  for (const auto& [stamp_ns, T] : trajectory) message.poses.push_back({node_stamp(stamp_ns), pose_message(T)});
  if (!message.poses.empty()) message.stamp = message.poses.back().stamp;
  return message;
}

CloudMessage cloud_message(const std::vector<Eigen::Vector3f>& points, std::int64_t stamp_ns,
                           const std::string& frame) {
  static_assert(sizeof(Eigen::Vector3f) == kCloudPointBytes);
  CloudMessage message{node_stamp(stamp_ns), frame, static_cast<std::uint32_t>(points.size()), {}};
  message.data.resize(points.size() * kCloudPointBytes);
  if (!points.empty()) std::memcpy(message.data.data(), points.front().data(), message.data.size());
  return message;
}

}  // namespace rilo
