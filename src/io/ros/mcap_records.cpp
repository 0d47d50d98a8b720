#include "io/ros/mcap_records.hpp"

#include <algorithm>
#include <utility>
#include <zlib.h>

#include "io/ros/unpack.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail::mcap {

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

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

MessageIndex take_message_index(ByteCursor cursor) {
  constexpr std::size_t kEntry = 16;  // log time and offset of a message
  MessageIndex index;
  index.channel_id = cursor.take<std::uint16_t>("channel id");
  index.messages = cursor.take_text("message index").size() / kEntry;
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

RecordFile::RecordFile(const std::filesystem::path& path) : file_(path) {
  if (file_.size() >= kMagic.size()) file_.read(0, kMagic.size(), bytes_);
  if (std::string_view(bytes_.data(), bytes_.size()) == kMagic) return;
  const bool small = file_.size() < kMagic.size();
  throw IoError({path, "byte 0", small ? "a file of " + counted(file_.size(), "byte") : "other bytes",
                 "the start of an MCAP file, 89 4d 43 41 50 30 0d 0a",
                 "Check what kind of file this is; the recorder may not have got to write anything"});
}

std::optional<Record> RecordFile::record_at(std::uint64_t offset) {
  if (offset >= file_.size()) return std::nullopt;
  Record record{Opcode::kHeader, offset, offset + kRecordHeader, 0};
  if (file_.size() - offset >= kRecordHeader) {
    file_.read(offset, kRecordHeader, bytes_);
    const BytesOrigin origin = origin_of(offset);
    ByteCursor cursor({bytes_.data(), bytes_.size()}, origin);
    record.opcode = static_cast<Opcode>(cursor.take<std::uint8_t>("opcode"));
    record.length = cursor.take<std::uint64_t>("length");
    if (record.length <= file_.size() - record.content) return record;
  }
  note_cut(offset);
  return std::nullopt;
}

std::string_view RecordFile::content_of(const Record& record) {
  if (record.length > kLargestUnpacked) {
    throw IoError({file_.path(), "byte " + std::to_string(record.offset),
                   "a record of " + counted(record.length, "byte"), "at most " + std::to_string(kLargestUnpacked),
                   "The file is damaged: copy or record it again"});
  }
  file_.read(record.content, static_cast<std::size_t>(record.length), bytes_);
  return {bytes_.data(), bytes_.size()};
}

BytesOrigin RecordFile::origin_of(std::uint64_t offset) const {
  return {file_.path(), "record at byte " + std::to_string(offset)};
}

void RecordFile::note_cut(std::uint64_t offset) {
  const std::string warning = file_.path().string() + ": cut off in the record at byte " + std::to_string(offset) +
                              ": what comes before it is used";
  if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
}

}  // namespace rilo::detail::mcap
