#include "io/ros/driver_messages.hpp"

#include <utility>

#include "io/packets/velodyne.hpp"
#include "io/ros/message_cursor.hpp"

namespace rilo::detail {

LivoxMessage parse_livox(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin) {
  constexpr std::size_t kPointBytes = 19;  // without what CDR puts between two of them
  constexpr std::size_t kReserved = 3;
  MessageCursor cursor(bytes, encoding, origin);
  MessageHeaderFields header = take_header(cursor);
  LivoxMessage message;
  message.stamp_ns = header.stamp_ns;
  message.frame_id = std::move(header.frame_id);
  cursor.take<std::uint64_t>("timebase");  // the stamp again, or the sensor's own clock where it is not set
  cursor.take<std::uint32_t>("point_num");
  message.lidar_id = cursor.take<std::uint8_t>("lidar_id");
  cursor.take_bytes(kReserved, "rsvd");
  const std::size_t count = take_count(cursor, kPointBytes, "points", "Livox CustomMsg");
  RawTimes times{"offset_time", ScalarType::kUint32, {}, {}};
  times.integers.reserve(count);
  RawCloud& cloud = message.cloud;
  cloud.points.reserve(count);
  cloud.intensities.reserve(count);
  cloud.rings.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    times.integers.push_back(cursor.take<std::uint32_t>("offset_time"));
    const auto x = cursor.take<float>("x");
    const auto y = cursor.take<float>("y");
    const auto z = cursor.take<float>("z");
    cloud.points.emplace_back(x, y, z);
    cloud.intensities.push_back(cursor.take<std::uint8_t>("reflectivity"));
    cursor.take<std::uint8_t>("tag");
    cloud.rings.push_back(cursor.take<std::uint8_t>("line"));
  }
  cloud.times = std::move(times);
  return message;
}

VelodyneScan parse_velodyne_scan(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin) {
  constexpr std::size_t kStampBytes = 8;
  MessageCursor cursor(bytes, encoding, origin);
  VelodyneScan scan;
  scan.frame_id = take_header(cursor).frame_id;
  scan.packets.resize(take_count(cursor, kStampBytes + kVelodynePacket, "packets", "VelodyneScan"));
  for (RecordedPacket& packet : scan.packets) {
    packet.received_ns = take_stamp_ns(cursor);
    packet.data = cursor.take_bytes(kVelodynePacket, "packet");
  }
  return scan;
}

std::string_view parse_ouster_packet(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin) {
  return MessageCursor(bytes, encoding, origin).take_sequence("buf");
}

std::string parse_text_message(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin) {
  return MessageCursor(bytes, encoding, origin).take_string("data");
}

}  // namespace rilo::detail
