// Messages of the sensors' own drivers: Livox' clouds, packets as they came, metadata.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/point_cloud2.hpp"

namespace rilo::detail {

/// Livox' CustomMsg: of livox_ros_driver and livox_ros_driver2, in ROS 1 and ROS 2 the same fields.
struct LivoxMessage {
  std::int64_t stamp_ns = 0;  ///< of the header
  std::string frame_id;
  std::uint8_t lidar_id = 0;  ///< tells apart several sensors of one driver
  /// m; reflectivities 0 … 255, the lines as rings, `offset_time` in ns since the stamp. Points without a return are
  /// at the origin.
  RawCloud cloud;
};

/// @throws IoError, with the byte, when the bytes are not a CustomMsg.
LivoxMessage parse_livox(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin);

/// `data` looks into the bytes it was parsed from.
struct RecordedPacket {
  std::int64_t received_ns = 0;  ///< by the driver; 0: unknown
  std::string_view data;
};

struct VelodyneScan {
  std::string frame_id;
  std::vector<RecordedPacket> packets;
};

/// velodyne_msgs/VelodyneScan: about a revolution. @throws IoError, with the byte, when the bytes are not one.
VelodyneScan parse_velodyne_scan(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin);

/// The packet of a PacketMsg of ouster_ros, ouster_msgs or ouster_sensor_msgs. @throws IoError as above.
std::string_view parse_ouster_packet(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin);

/// std_msgs/String. @throws IoError as above.
std::string parse_text_message(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin);

}  // namespace rilo::detail
