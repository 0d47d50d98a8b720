// The poses of a run as a ROS 1 bag, by ROS' own library. Its message classes do not compile as C++20; their names,
// definitions and checksums do, and the bytes are ours.
#include <algorithm>
#include <cstdint>
#include <nav_msgs/Odometry.h>
#include <new>
#include <rosbag/bag.h>
#include <stdexcept>
#include <string>
#include <tf2_msgs/TFMessage.h>

#include "io/atomic_file.hpp"
#include "io/ros/pose_messages.hpp"
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

using detail::BagMessage;

// Messages at time 0 there are none.
ros::Time message_time(std::int64_t stamp_ns) {
  const detail::MessageStamp stamp = detail::message_stamp(stamp_ns, 1, detail::kLastRos1Second);
  return {stamp.seconds, stamp.nanoseconds};
}

}  // namespace

bool can_write_bags() { return true; }

void write_bag(const std::filesystem::path& file, std::span<const SweepResult> results, const RecordingNames& names) {
  constexpr MessageEncoding kRos1 = MessageEncoding::kRos1;
  AtomicFile target(file);
  try {
    rosbag::Bag bag(target.temporary().string(), rosbag::bagmode::Write);
    for (std::size_t i = 0; i < results.size(); ++i) {
      const ros::Time time = message_time(results[i].stamp_ns);
      bag.write(names.odometry_topic, time,
                BagMessage<nav_msgs::Odometry>{detail::odometry_message(kRos1, results, i, names).bytes()});
      bag.write(names.tf_topic, time,
                BagMessage<tf2_msgs::TFMessage>{detail::transform_message(kRos1, results, i, names).bytes()});
    }
    bag.close();
  } catch (const rosbag::BagException& error) {
    throw IoError({file, "", std::string("it cannot be written: ") + error.what(), "a file that can be written",
                   "Free some disk space or choose another output path"});
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    // ROS' library opens plug-ins of its own, and does not say when it was memory that they lacked.
    throw std::runtime_error(file.string() + ": it cannot be written: " + error.what() +
                             " (out of memory, or the plug-ins of librosbag-storage are not installed)");
  }
  target.commit();
}

}  // namespace rilo
