#include "io/ros/packet_messages.hpp"

#include "io/packets/velodyne.hpp"
#include "io/ros/message_cursor.hpp"

namespace rilo::detail {

VelodyneScan parse_velodyne_scan(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                                 const std::string& part) {
  constexpr std::size_t kStampBytes = 8;
  const BytesOrigin origin{file, part};
  MessageCursor cursor(bytes, encoding, origin);
  VelodyneScan scan;
  scan.frame_id = take_header(cursor, encoding).frame_id;
  scan.packets.resize(take_count(cursor, kStampBytes + kVelodynePacket, "packets", "VelodyneScan"));
  for (RecordedPacket& packet : scan.packets) {
    packet.received_ns = take_stamp_ns(cursor, encoding);
    packet.data = cursor.take_bytes(kVelodynePacket, "packet");
  }
  return scan;
}

std::string_view parse_ouster_packet(std::string_view bytes, MessageEncoding encoding,
                                     const std::filesystem::path& file, const std::string& part) {
  const BytesOrigin origin{file, part};
  return MessageCursor(bytes, encoding, origin).take_sequence("buf");
}

std::string parse_text_message(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                               const std::string& part) {
  const BytesOrigin origin{file, part};
  return MessageCursor(bytes, encoding, origin).take_string("data");
}

}  // namespace rilo::detail
