// ROS 1 bags by ROS' own writer.
#include <ros/serialization.h>
#include <rosbag/bag.h>

#include "io/ros/ros_bytes.hpp"

namespace rilo::test {
/// A message that is bytes already; its type is told at run time.
struct PackedMessage {
  std::string type;
  std::string bytes;
};
}  // namespace rilo::test

namespace ros {
namespace message_traits {
template <>
struct MD5Sum<rilo::test::PackedMessage> {
  static const char* value() { return "1158d486dd51d683ce2f1be655c3c181"; }
  static const char* value(const rilo::test::PackedMessage&) { return value(); }
};
template <>
struct DataType<rilo::test::PackedMessage> {
  static const char* value(const rilo::test::PackedMessage& message) { return message.type.c_str(); }
};
template <>
struct Definition<rilo::test::PackedMessage> {
  static const char* value(const rilo::test::PackedMessage&) { return "Header header\n"; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<rilo::test::PackedMessage> {
  template <typename Stream>
  static void write(Stream& stream, const rilo::test::PackedMessage& message) {
    std::memcpy(stream.advance(static_cast<std::uint32_t>(message.bytes.size())), message.bytes.data(),
                message.bytes.size());
  }
  // NOLINTNEXTLINE(readability-identifier-naming): the name that roscpp calls
  static std::uint32_t serializedLength(const rilo::test::PackedMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace rilo::test {

void write_bag(const std::filesystem::path& file, const Topics& topics, const std::vector<Recorded>& messages,
               const std::string& compression) {
  rosbag::Bag bag(file.string(), rosbag::bagmode::Write);
  if (compression == "bz2") bag.setCompression(rosbag::compression::BZ2);
  if (compression == "lz4") bag.setCompression(rosbag::compression::LZ4);
  bag.setChunkThreshold(2000);  // several chunks
  for (const Recorded& message : messages) {
    std::string type;
    for (const auto& [name, its_type] : topics) type = name == message.topic ? its_type : type;
    ros::Time time;
    time.fromNSec(static_cast<std::uint64_t>(message.received_ns));
    bag.write(message.topic, time, PackedMessage{type, message.bytes});
  }
  bag.close();
}

}  // namespace rilo::test
