// The records inside a chunk of an MCAP file, which may be packed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "io/ros/mcap_records.hpp"

namespace rilo::detail::mcap {

/// A record of a chunk; valid until another chunk is opened, or this one closed.
struct ChunkRecord {
  Opcode opcode = Opcode::kHeader;
  ByteCursor content;
};

/// One chunk at a time, unpacked into a buffer that is kept.
class OpenChunk {
 public:
  /// @throws IoError when the chunk is damaged, or packed in a way that is not ours; it is closed then.
  void open(RecordFile& file, const Record& record);
  void close();

  bool at_end() const { return place_ >= bytes_.size(); }

  /// @throws IoError when it is damaged.
  ChunkRecord next();

  /// Whether the one opened last could be unpacked, and its CRC is right.
  bool whole() const { return whole_; }

  /// Of the last one that was packed, "zstd" or "lz4"; empty: none was.
  const std::string& compression() const { return compression_; }

 private:
  void unpack(const ChunkHeader& header, std::string_view packed);
  [[noreturn]] void reject(const std::string& found, const std::string& expected) const;

  std::vector<char> bytes_;
  std::size_t place_ = 0;  // of the next record
  bool whole_ = false;
  std::string compression_;
  BytesOrigin origin_;
};

}  // namespace rilo::detail::mcap
