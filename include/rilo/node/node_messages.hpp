// What the odometry says, in the fields of ROS' messages. The nodes copy them field by field.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// std_msgs/Header's stamp. ROS knows no time before 1970: that becomes 0.
struct NodeStamp {
  std::uint32_t seconds = 0;  ///< at most 2³¹ − 1, as ROS 2 has them
  std::uint32_t nanoseconds = 0;
};
NodeStamp node_stamp(std::int64_t stamp_ns);

/// geometry_msgs/Pose; of the two quaternions the one with w >= 0.
struct PoseMessage {
  Eigen::Vector3d position;
  Eigen::Quaterniond orientation;
};

/// geometry_msgs/PoseStamped.
struct StampedPoseMessage {
  NodeStamp stamp;
  PoseMessage pose;
};

/// nav_msgs/Odometry. Covariances: rows of [x, y, z, about x, about y, about z].
struct OdometryMessage {
  NodeStamp stamp;
  std::string frame;
  std::string child_frame;
  PoseMessage pose;
  std::array<double, 36> pose_covariance;
  Eigen::Vector3d linear;   ///< m/s, in child_frame
  Eigen::Vector3d angular;  ///< rad/s
  std::array<double, 36> twist_covariance;
};

/// geometry_msgs/TransformStamped.
struct TransformMessage {
  NodeStamp stamp;
  std::string frame;
  std::string child_frame;
  PoseMessage transform;
};

/// nav_msgs/Path.
struct PathMessage {
  NodeStamp stamp;
  std::string frame;
  std::vector<StampedPoseMessage> poses;
};

/// sensor_msgs/PointCloud2 of kCloudFields, each a float32, little-endian.
struct CloudMessage {
  NodeStamp stamp;
  std::string frame;
  std::uint32_t width = 0;  ///< points; the height is 1
  std::vector<std::uint8_t> data;
};
inline constexpr std::array<const char*, 3> kCloudFields{"x", "y", "z"};
inline constexpr std::uint32_t kCloudFieldBytes = 4;
inline constexpr std::uint32_t kCloudPointBytes = 3 * kCloudFieldBytes;

/// diagnostic_msgs/DiagnosticStatus, with its levels.
enum class NodeLevel : std::uint8_t { kOk, kWarn, kError, kStale };
struct StatusMessage {
  NodeLevel level = NodeLevel::kOk;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

/// Pose in odom_frame with the covariance given the pose before; velocity in base_frame, its covariance that of the
/// pose over `step_s`, the time since the pose before (0: there is none, the velocity is unknown).
OdometryMessage odometry_message(const SweepResult& result, double step_s, const std::string& odom_frame,
                                 const std::string& base_frame);

/// odom_frame → base_frame, or the inverse: base_frame → odom_frame.
TransformMessage transform_message(const SweepResult& result, bool inverted, const std::string& odom_frame,
                                   const std::string& base_frame);

PathMessage path_message(const Trajectory& trajectory, const std::string& odom_frame);

CloudMessage cloud_message(const std::vector<Eigen::Vector3f>& points, std::int64_t stamp_ns, const std::string& frame);

}  // namespace rilo
