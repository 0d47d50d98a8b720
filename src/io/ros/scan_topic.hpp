// Which topics of a recording hold scans, and in what form.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/ros/recording.hpp"

namespace rilo::detail {

/// What the messages of a topic hold.
enum class ScanForm : std::uint8_t {
  kNone,             ///< nothing that we read
  kPointCloud2,      ///< sensor_msgs/PointCloud2
  kLivoxCustom,      ///< CustomMsg of livox_ros_driver, livox_ros_driver2 or livox_interfaces
  kVelodynePackets,  ///< velodyne_msgs/VelodyneScan
  kOusterPackets,    ///< PacketMsg of ouster_ros, ouster_msgs or ouster_sensor_msgs: of the LiDAR or of the IMU
};
ScanForm scan_form(const RecordedTopic& topic);

/// kVelodynePackets or kOusterPackets.
bool is_packets(ScanForm form);

/// std_msgs/String; an Ouster's driver publishes its metadata so.
bool is_text(const RecordedTopic& topic);

/// Topics of clouds (PointCloud2, CustomMsg), or, where there is none, of LiDAR packets.
std::vector<RecordedTopic> scan_topics(const std::vector<RecordedTopic>& topics);

/// The topic called `wanted` (a slash at its beginning may be missing); if that is empty, the only one of
/// scan_topics().
/// @throws IoError that lists the topics when there is no such topic or more than one.
RecordedTopic choose_topic(const std::filesystem::path& path, const std::vector<RecordedTopic>& topics,
                           const std::string& wanted);

}  // namespace rilo::detail
