// The poses of a run as a ROS 1 bag, by ROS' own library. Its message classes do not compile as C++20; their names,
// definitions and checksums do, and the bytes are written here: little-endian, one field behind the other.
#include <algorithm>
#include <cstdint>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <string>
#include <tf2_msgs/TFMessage.h>

#include "io/atomic_file.hpp"
#include "io/raw_bytes.hpp"
#include "io/ros/message_stamp.hpp"
#include "io/ros/ros_covariance.hpp"
#include "io/unit_quaternion.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {

/// A message of type `Type` as it lies in a bag.
template <typename Type>
struct BagMessage {
  std::string bytes;
};

}  // namespace rilo::detail

namespace ros {
namespace message_traits {
template <typename Type>
struct MD5Sum<rilo::detail::BagMessage<Type>> {
  static const char* value() { return MD5Sum<Type>::value(); }
  static const char* value(const rilo::detail::BagMessage<Type>& /*message*/) { return value(); }
};
template <typename Type>
struct DataType<rilo::detail::BagMessage<Type>> {
  static const char* value() { return DataType<Type>::value(); }
  static const char* value(const rilo::detail::BagMessage<Type>& /*message*/) { return value(); }
};
template <typename Type>
struct Definition<rilo::detail::BagMessage<Type>> {
  static const char* value() { return Definition<Type>::value(); }
  static const char* value(const rilo::detail::BagMessage<Type>& /*message*/) { return value(); }
};
}  // namespace message_traits
namespace serialization {
template <typename Type>
struct Serializer<rilo::detail::BagMessage<Type>> {
  template <typename Stream>
  static void write(Stream& stream, const rilo::detail::BagMessage<Type>& message) {
    const auto size = static_cast<std::uint32_t>(message.bytes.size());
    std::copy_n(message.bytes.data(), size, reinterpret_cast<char*>(stream.advance(size)));
  }
  static std::uint32_t serializedLength(  // NOLINT(readability-identifier-naming): ROS' name
      const rilo::detail::BagMessage<Type>& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace rilo {
namespace {

using detail::append_bytes;
using detail::BagMessage;

ros::Time ros_time(std::int64_t stamp_ns, std::int64_t least_ns) {
  constexpr std::uint32_t kLastSecond = 0xFFFFFFFF;
  const detail::MessageStamp stamp = detail::message_stamp(stamp_ns, least_ns, kLastSecond);
  return {stamp.seconds, stamp.nanoseconds};
}

void append_text(std::string& bytes, const std::string& text) {
  append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

void append_vector(std::string& bytes, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) append_bytes(bytes, value);
}

// Header, child_frame_id, and where the sensor is: the beginning of both messages.
void append_stamped_pose(std::string& bytes, const SweepResult& result, std::uint32_t number,
                         const RecordingNames& names) {
  const ros::Time stamp = ros_time(result.stamp_ns, 0);
  for (const std::uint32_t value : {number, stamp.sec, stamp.nsec}) append_bytes(bytes, value);
  append_text(bytes, names.odom_frame);
  append_text(bytes, names.lidar_frame);
  append_vector(bytes, result.T_odom_lidar.translation());
  const Eigen::Quaterniond q = detail::unit_quaternion(result.T_odom_lidar);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) append_bytes(bytes, value);
}

// Symmetric: the storage order does not matter.
void append_covariance(std::string& bytes, const Matrix6d& covariance) {
  for (const double value : covariance.reshaped()) append_bytes(bytes, value);
}

BagMessage<nav_msgs::Odometry> bag_odometry(const SweepResult& result, double step_s, std::uint32_t number,
                                            const RecordingNames& names) {
  BagMessage<nav_msgs::Odometry> message;
  append_stamped_pose(message.bytes, result, number, names);
  append_covariance(message.bytes, ros_pose_covariance(result.T_odom_lidar, result.covariance));
  append_vector(message.bytes, result.twist.tail<3>());
  append_vector(message.bytes, result.twist.head<3>());
  append_covariance(message.bytes, ros_twist_covariance(result.covariance, step_s));
  return message;
}

BagMessage<tf2_msgs::TFMessage> bag_transform(const SweepResult& result, std::uint32_t number,
                                              const RecordingNames& names) {
  BagMessage<tf2_msgs::TFMessage> message;
  append_bytes(message.bytes, std::uint32_t{1});
  append_stamped_pose(message.bytes, result, number, names);
  return message;
}

}  // namespace

bool can_write_bags() { return true; }

void write_bag(const std::filesystem::path& file, std::span<const SweepResult> results, const RecordingNames& names) {
  AtomicFile target(file);
  try {
    rosbag::Bag bag(target.temporary().string(), rosbag::bagmode::Write);
    for (std::size_t i = 0; i < results.size(); ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      const ros::Time time = ros_time(results[i].stamp_ns, 1);
      bag.write(names.odometry_topic, time, bag_odometry(results[i], detail::step_to(results, i), number, names));
      bag.write(names.tf_topic, time, bag_transform(results[i], number, names));
    }
    bag.close();
  } catch (const rosbag::BagException& error) {
    throw IoError({file, "", std::string("it cannot be written: ") + error.what(), "a file that can be written",
                   "Free some disk space or choose another output path"});
  }
  target.commit();
}

}  // namespace rilo
