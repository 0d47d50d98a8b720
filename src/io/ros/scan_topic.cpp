#include "io/ros/scan_topic.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

bool is_known_encoding(const RecordedTopic& topic) { return topic.encoding == "ros1" || topic.encoding == "cdr"; }

// ROS 2 puts "msg" between package and name.
std::string without_msg(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

std::string list_of(const std::vector<RecordedTopic>& topics) {
  std::string text;
  for (const RecordedTopic& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type +
            (is_known_encoding(topic) ? "" : ", encoding " + in_quotes(topic.encoding)) +
            (topic.messages ? ", " + counted(*topic.messages, "message") + ")" : ")");
  }
  return text.empty() ? "no topics" : text;
}

bool has_name(const RecordedTopic& topic, const std::string& wanted) {
  return topic.name == wanted || topic.name == "/" + wanted || "/" + topic.name == wanted;
}

// An Ouster's driver records the packets of the IMU as the same type.
bool is_imu(const RecordedTopic& topic) {
  return scan_form(topic) == ScanForm::kOusterPackets && lower_case(topic.name).find("imu") != std::string::npos;
}

template <typename Wanted>
std::vector<RecordedTopic> topics_with(const std::vector<RecordedTopic>& topics, Wanted&& wanted) {
  std::vector<RecordedTopic> found;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(found), wanted);
  return found;
}

constexpr const char* kKnownTypes =
    "sensor_msgs/PointCloud2, Livox CustomMsg, velodyne_msgs/VelodyneScan or Ouster PacketMsg";

}  // namespace

ScanForm scan_form(const RecordedTopic& topic) {
  constexpr std::array<std::pair<std::string_view, ScanForm>, 8> kForms{{
      {"sensor_msgs/PointCloud2", ScanForm::kPointCloud2},
      {"livox_ros_driver/CustomMsg", ScanForm::kLivoxCustom},
      {"livox_ros_driver2/CustomMsg", ScanForm::kLivoxCustom},
      {"livox_interfaces/CustomMsg", ScanForm::kLivoxCustom},
      {"velodyne_msgs/VelodyneScan", ScanForm::kVelodynePackets},
      {"ouster_ros/PacketMsg", ScanForm::kOusterPackets},
      {"ouster_msgs/PacketMsg", ScanForm::kOusterPackets},
      {"ouster_sensor_msgs/PacketMsg", ScanForm::kOusterPackets},
  }};
  if (!is_known_encoding(topic)) return ScanForm::kNone;
  const std::string type = without_msg(topic.type);
  for (const auto& [name, form] : kForms) {
    if (name == type) return form;
  }
  return ScanForm::kNone;
}

bool is_packets(ScanForm form) { return form == ScanForm::kVelodynePackets || form == ScanForm::kOusterPackets; }

bool is_text(const RecordedTopic& topic) {
  return is_known_encoding(topic) && without_msg(topic.type) == "std_msgs/String";
}

std::vector<RecordedTopic> scan_topics(const std::vector<RecordedTopic>& topics) {
  auto clouds = topics_with(topics, [](const RecordedTopic& topic) {
    const ScanForm form = scan_form(topic);
    return form == ScanForm::kPointCloud2 || form == ScanForm::kLivoxCustom;
  });
  if (!clouds.empty()) return clouds;
  return topics_with(topics, [](const RecordedTopic& topic) { return is_packets(scan_form(topic)) && !is_imu(topic); });
}

RecordedTopic choose_topic(const std::filesystem::path& path, const std::vector<RecordedTopic>& topics,
                           const std::string& wanted) {
  if (!wanted.empty()) {
    const auto named = topics_with(topics, [&](const RecordedTopic& topic) {
      return has_name(topic, wanted) && scan_form(topic) != ScanForm::kNone;
    });
    if (named.size() == 1) return named[0];
    throw IoError({path, "", list_of(topics),
                   "the topic " + in_quotes(wanted) + " with messages of type " + kKnownTypes,
                   "Name one of these with --topic, or omit it when only one holds scans"});
  }
  const auto found = scan_topics(topics);
  if (found.size() == 1) return found[0];
  if (found.size() > 1) {
    const std::string kind = is_packets(scan_form(found[0])) ? "LiDAR packets" : "point clouds";
    throw IoError({path, "", counted(found.size(), "topic") + " of " + kind + ": " + list_of(found), "one",
                   "Choose one with --topic"});
  }
  const auto has_type = [&](std::string_view type) {
    return std::any_of(topics.begin(), topics.end(),
                       [&](const RecordedTopic& topic) { return without_msg(topic.type) == type; });
  };
  std::string remedy = "Record the sensor's point clouds (sensor_msgs/PointCloud2)";
  if (has_type("sensor_msgs/LaserScan")) remedy += "; scans of one plane (LaserScan) do not give a pose in space";
  if (has_type("sensor_msgs/PointCloud")) {
    remedy += "; those of version 1 (PointCloud) are not read: point_cloud_converter makes PointCloud2 of them";
  }
  throw IoError({path, "", "no scans in " + list_of(topics),
                 std::string("a topic of type ") + kKnownTypes + " in ROS 1's or CDR encoding", remedy});
}

}  // namespace rilo::detail
