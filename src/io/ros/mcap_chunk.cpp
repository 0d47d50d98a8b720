#include "io/ros/mcap_chunk.hpp"

#include <algorithm>

#include "io/ros/unpack.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail::mcap {

void OpenChunk::open(RecordFile& file, const Record& record) {
  close();
  whole_ = false;
  origin_ = {file.path(), "chunk at byte " + std::to_string(record.offset)};
  file.look_into(record, [&](ByteCursor cursor) {
    const ChunkHeader header = take_chunk_header(cursor);
    const auto size = cursor.take<std::uint64_t>("size of the records");
    const std::string_view packed = cursor.take_bytes(static_cast<std::size_t>(size), "records");
    try {
      unpack(header, packed);
    } catch (const IoError&) {
      close();
      throw;
    }
  });
  whole_ = true;
}

void OpenChunk::close() {
  bytes_.clear();
  place_ = 0;
}

ChunkRecord OpenChunk::next() {
  ByteCursor rest(std::string_view(bytes_.data(), bytes_.size()).substr(place_), origin_, place_);
  const auto opcode = static_cast<Opcode>(rest.take<std::uint8_t>("opcode"));
  const auto length = rest.take<std::uint64_t>("length");
  const std::size_t start = place_ + rest.offset();
  const std::string_view content = rest.take_bytes(static_cast<std::size_t>(length), "record");
  place_ += rest.offset();
  return {opcode, ByteCursor(content, origin_, start)};
}

void OpenChunk::unpack(const ChunkHeader& header, std::string_view packed) {
  const auto limit = static_cast<std::size_t>(std::min<std::uint64_t>(header.unpacked_bytes, kLargestUnpacked));
  if (header.compression == "zstd") {
    unpack_zstd(packed, limit, origin_, bytes_);
  } else if (header.compression == "lz4") {
    unpack_lz4(packed, limit, origin_, bytes_);
  } else if (header.compression.empty()) {
    bytes_.assign(packed.begin(), packed.end());
  } else {
    reject("the compression " + in_quotes(header.compression), "zstd, lz4 or none");
  }
  if (!header.compression.empty()) compression_ = header.compression;
  if (bytes_.size() != header.unpacked_bytes) {
    reject(counted(bytes_.size(), "byte") + " unpacked", std::to_string(header.unpacked_bytes));
  }
  const std::uint32_t crc = crc_of({bytes_.data(), bytes_.size()});
  if (header.crc != 0 && crc != header.crc) {
    reject("CRC " + std::to_string(crc), "CRC " + std::to_string(header.crc));
  }
}

void OpenChunk::reject(const std::string& found, const std::string& expected) const {
  throw IoError({origin_.file, origin_.part, found, expected,
                 "The file is damaged: copy it again, or leave the chunk out with --skip-bad-sweeps"});
}

}  // namespace rilo::detail::mcap
