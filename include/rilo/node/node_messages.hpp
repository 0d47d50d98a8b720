// Results of the odometry in the fields of ROS' messages, and the copy into the messages of either ROS.
#pragma once

#include <algorithm>
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

/// `Stamps::set(NodeStamp, stamp)` writes a header's stamp.
template <typename Stamps>
struct MessageFields {
  template <typename Odometry>
  static void copy(const OdometryMessage& from, Odometry& to) {
    copy_header(from, to.header);
    to.child_frame_id = from.child_frame;
    copy(from.pose, to.pose.pose);
    std::copy(from.pose_covariance.begin(), from.pose_covariance.end(), to.pose.covariance.begin());
    copy(from.linear, to.twist.twist.linear);
    copy(from.angular, to.twist.twist.angular);
    std::copy(from.twist_covariance.begin(), from.twist_covariance.end(), to.twist.covariance.begin());
  }

  template <typename TransformStamped>
  static void copy(const TransformMessage& from, TransformStamped& to) {
    copy_header(from, to.header);
    to.child_frame_id = from.child_frame;
    copy(from.transform.position, to.transform.translation);
    copy(from.transform.orientation, to.transform.rotation);
  }

  template <typename Path>
  static void copy(const PathMessage& from, Path& to) {
    copy_header(from, to.header);
    to.poses.resize(from.poses.size());
    for (std::size_t i = 0; i < from.poses.size(); ++i) {
      to.poses[i].header.frame_id = from.frame;
      Stamps::set(from.poses[i].stamp, to.poses[i].header.stamp);
      copy(from.poses[i].pose, to.poses[i].pose);
    }
  }

  template <typename PointCloud2>
  static void copy(CloudMessage&& from, PointCloud2& to) {
    constexpr std::uint8_t kFloat32 = 7;
    copy_header(from, to.header);
    to.height = 1;
    to.width = from.width;
    to.fields.resize(kCloudFields.size());
    for (std::uint32_t i = 0; i < kCloudFields.size(); ++i) {
      to.fields[i].name = kCloudFields.at(i);
      to.fields[i].offset = i * kCloudFieldBytes;
      to.fields[i].datatype = kFloat32;
      to.fields[i].count = 1;
    }
    to.is_bigendian = false;
    to.point_step = kCloudPointBytes;
    to.row_step = static_cast<std::uint32_t>(from.data.size());
    to.data = std::move(from.data);
    to.is_dense = true;
  }

  template <typename Pose>
  static Eigen::Vector3d position_of(const Pose& pose) {
    return {pose.position.x, pose.position.y, pose.position.z};
  }

  template <typename Pose>
  static Eigen::Quaterniond orientation_of(const Pose& pose) {
    return {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z};
  }

  /// Of a geometry_msgs/Transform: a quaternion of few digits has not quite length 1.
  template <typename Transform>
  static SE3 pose_of(const Transform& transform) {
    const auto& q = transform.rotation;
    const auto& t = transform.translation;
    SE3 T = SE3::Identity();
    T.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    T.translation() << t.x, t.y, t.z;
    return T;
  }

 private:
  template <typename Message, typename Header>
  static void copy_header(const Message& from, Header& to) {
    to.frame_id = from.frame;
    Stamps::set(from.stamp, to.stamp);
  }

  // Point or Vector3.
  template <typename Vector>
  static void copy(const Eigen::Vector3d& from, Vector& to) {
    to.x = from.x();
    to.y = from.y();
    to.z = from.z();
  }

  template <typename Quaternion>
  static void copy(const Eigen::Quaterniond& from, Quaternion& to) {
    to.x = from.x();
    to.y = from.y();
    to.z = from.z();
    to.w = from.w();
  }

  template <typename Pose>
  static void copy(const PoseMessage& from, Pose& to) {
    copy(from.position, to.position);
    copy(from.orientation, to.orientation);
  }
};

}  // namespace rilo
