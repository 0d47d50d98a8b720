// The records of an MCAP file, and those that we look into. The format: https://mcap.dev/spec
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "io/file_bytes.hpp"

namespace rilo::detail::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

/// CRC-32, as the format has it.
std::uint32_t crc_of(std::string_view bytes);

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F,
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic;
  std::string encoding;
};

/// All channels of a file, as far as they have been read.
struct Channels {
  std::map<std::uint16_t, std::string> schemas;  ///< id → name
  std::map<std::uint16_t, Channel> channels;

  void add_schema(ByteCursor cursor);
  void add_channel(ByteCursor cursor);
};

struct MessageHeader {
  static constexpr std::size_t kBytes = 22;
  std::uint16_t channel_id = 0;
  std::int64_t log_time_ns = 0;
};
MessageHeader take_message_header(ByteCursor& cursor);

struct ChunkHeader {
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;  ///< of the unpacked bytes; 0: none
  std::string compression;
};
ChunkHeader take_chunk_header(ByteCursor& cursor);

struct ChunkIndex {
  std::uint64_t offset = 0;             ///< of the chunk's record
  std::vector<std::uint16_t> channels;  ///< that have messages in it; empty: unknown
};
ChunkIndex take_chunk_index(ByteCursor cursor);

/// Of the records behind a chunk, one for each channel that has messages in it.
struct MessageIndex {
  std::uint16_t channel_id = 0;
  std::size_t messages = 0;
};
MessageIndex take_message_index(ByteCursor cursor);

/// Messages by channel. Empty when the file does not say.
std::map<std::uint16_t, std::uint64_t> take_message_counts(ByteCursor cursor);

inline constexpr std::size_t kRecordHeader = 9;  // opcode and length

struct Record {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t offset = 0;   ///< of the record
  std::uint64_t content = 0;  ///< of what follows its header
  std::uint64_t length = 0;   ///< of that

  std::uint64_t end() const { return content + length; }
};

class RecordFile {
 public:
  /// @throws IoError when it is not an MCAP file.
  explicit RecordFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size() const { return file_.size(); }

  /// The record at `offset`, or nothing where the file ends. A record that is cut off is the end, too, with a warning.
  std::optional<Record> record_at(std::uint64_t offset);

  /// The content, valid until the next call. @throws IoError when it is absurdly large or cannot be read.
  std::string_view content_of(const Record& record);

  /// Calls `use` with a cursor over the content.
  template <typename Use>
  void look_into(const Record& record, Use&& use) {
    const std::string_view content = content_of(record);
    const BytesOrigin origin = origin_of(record.offset);
    use(ByteCursor(content, origin, kRecordHeader));
  }

  const std::vector<std::string>& warnings() const { return warnings_; }
  void forget_warnings() { warnings_.clear(); }

 private:
  BytesOrigin origin_of(std::uint64_t offset) const;
  void note_cut(std::uint64_t offset);

  RandomAccessFile file_;
  std::vector<char> bytes_;
  std::vector<std::string> warnings_;
};

}  // namespace rilo::detail::mcap
