#include "io/ros/mcap_records.hpp"

namespace rilo::detail::mcap {

void Channels::add_schema(ByteCursor cursor) {
  const auto id = cursor.take<std::uint16_t>("schema id");
  schemas[id] = std::string(cursor.take_text("schema name"));
}

void Channels::add_channel(ByteCursor cursor) {
  Channel channel;
  channel.id = cursor.take<std::uint16_t>("channel id");
  channel.schema_id = cursor.take<std::uint16_t>("schema id");
  channel.topic = std::string(cursor.take_text("topic"));
  channel.encoding = std::string(cursor.take_text("message encoding"));
  channels[channel.id] = std::move(channel);
}

MessageHeader take_message_header(ByteCursor& cursor) {
  MessageHeader header;
  header.channel_id = cursor.take<std::uint16_t>("channel id");
  cursor.take<std::uint32_t>("sequence");
  header.log_time_ns = static_cast<std::int64_t>(cursor.take<std::uint64_t>("log time"));
  cursor.take<std::uint64_t>("publish time");
  return header;
}

ChunkHeader take_chunk_header(ByteCursor& cursor) {
  ChunkHeader header;
  cursor.take<std::uint64_t>("start time");
  cursor.take<std::uint64_t>("end time");
  header.unpacked_bytes = cursor.take<std::uint64_t>("uncompressed size");
  header.crc = cursor.take<std::uint32_t>("CRC");
  header.compression = std::string(cursor.take_text("compression"));
  return header;
}

ChunkIndex take_chunk_index(ByteCursor cursor) {
  ChunkIndex index;
  cursor.take<std::uint64_t>("start time");
  cursor.take<std::uint64_t>("end time");
  index.offset = cursor.take<std::uint64_t>("chunk offset");
  cursor.take<std::uint64_t>("chunk length");
  ByteCursor offsets(cursor.take_text("message index offsets"), cursor.origin());
  while (!offsets.at_end()) {
    index.channels.push_back(offsets.take<std::uint16_t>("channel id"));
    offsets.take<std::uint64_t>("message index offset");
  }
  return index;
}

std::map<std::uint16_t, std::uint64_t> take_message_counts(ByteCursor cursor) {
  constexpr std::size_t kBeforeCounts = 42;
  cursor.take_bytes(kBeforeCounts, "statistics");
  std::map<std::uint16_t, std::uint64_t> counts;
  ByteCursor pairs(cursor.take_text("message counts"), cursor.origin());
  while (!pairs.at_end()) {
    const auto id = pairs.take<std::uint16_t>("channel id");
    counts[id] = pairs.take<std::uint64_t>("message count");
  }
  return counts;
}

}  // namespace rilo::detail::mcap
