// From the plain messages into those of ROS, whichever: both name the fields alike, all but those of a stamp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "rilo/node/node_messages.hpp"

namespace rilo {

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
