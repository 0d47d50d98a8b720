// Messages that hold a sensor's packets as they came.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/io/point_cloud2.hpp"

namespace rilo::detail {

/// `data` looks into the bytes it was parsed from.
struct RecordedPacket {
  std::int64_t received_ns = 0;  ///< by the driver; 0: unknown
  std::string_view data;
};

struct VelodyneScan {
  std::string frame_id;
  std::vector<RecordedPacket> packets;
};

/// velodyne_msgs/VelodyneScan: about a revolution. `file` and `part` ("message 17 of /velodyne_packets") are for
/// messages.
/// @throws IoError, with the byte, when the bytes are not one.
VelodyneScan parse_velodyne_scan(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                                 const std::string& part);

/// The packet of a PacketMsg of ouster_ros, ouster_msgs or ouster_sensor_msgs. @throws IoError as above.
std::string_view parse_ouster_packet(std::string_view bytes, MessageEncoding encoding,
                                     const std::filesystem::path& file, const std::string& part);

/// std_msgs/String. @throws IoError as above.
std::string parse_text_message(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                               const std::string& part);

}  // namespace rilo::detail
