#include "io/ros/pose_messages.hpp"

#include "io/stamp_difference.hpp"
#include "io/unit_quaternion.hpp"

namespace rilo::detail {
namespace {

void put_vector(MessageWriter& message, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) message.put(value);
}

void put_covariance(MessageWriter& message, const Matrix6d& covariance) {
  for (const double value : covariance.reshaped<Eigen::RowMajor>()) message.put(value);
}

// Header, child_frame_id, and where the sensor is: the beginning of both messages.
void put_stamped_pose(MessageWriter& message, std::span<const SweepResult> results, std::size_t i,
                      const RecordingNames& names) {
  message.put_header(static_cast<std::uint32_t>(i), results[i].stamp_ns, names.odom_frame);
  message.put_text(names.lidar_frame);
  put_vector(message, results[i].T_odom_lidar.translation());
  const Eigen::Quaterniond q = unit_quaternion(results[i].T_odom_lidar);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) message.put(value);
}

}  // namespace

MessageWriter odometry_message(MessageEncoding encoding, std::span<const SweepResult> results, std::size_t i,
                               const RecordingNames& names) {
  const SweepResult& result = results[i];
  const double step_s = i == 0 ? 0 : seconds_between(results[i - 1].stamp_ns, result.stamp_ns);
  MessageWriter message(encoding);
  put_stamped_pose(message, results, i, names);
  put_covariance(message, ros_pose_covariance(result.T_odom_lidar, result.covariance));
  put_vector(message, result.twist.tail<3>());
  put_vector(message, result.twist.head<3>());
  put_covariance(message, ros_twist_covariance(result.covariance, step_s));
  return message;
}

MessageWriter transform_message(MessageEncoding encoding, std::span<const SweepResult> results, std::size_t i,
                                const RecordingNames& names) {
  MessageWriter message(encoding);
  message.put(std::uint32_t{1});
  put_stamped_pose(message, results, i, names);
  return message;
}

}  // namespace rilo::detail
