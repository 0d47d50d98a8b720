// MCAP files, chunked and indexed, so that players seek in them. The format: https://mcap.dev/spec
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "io/atomic_file.hpp"

namespace rilo::detail {

/// Messages come in any order; those of one chunk are written together. Without finish() no file appears.
class McapWriter {
 public:
  /// @throws IoError as AtomicFile.
  explicit McapWriter(const std::filesystem::path& file);

  /// A topic with CDR messages of the type `schema`, whose definition is `definition` (ros2msg). Before the messages.
  /// @returns its number.
  std::uint16_t add_channel(std::string_view topic, std::string_view schema, std::string_view definition);

  /// Stamps before 1970 count as 1970: the format knows no others.
  void add_message(std::uint16_t channel, std::int64_t stamp_ns, std::string_view cdr);

  /// Writes what is waiting and the index, and puts the file in place.
  void finish();

 private:
  struct Chunk {
    std::string records;
    std::map<std::uint16_t, std::string> index;  // by channel: stamp and offset of each message
    std::uint64_t first_ns = 0;
    std::uint64_t last_ns = 0;
  };

  void write(std::string_view bytes);
  void close_chunk();
  std::string statistics() const;

  AtomicFile file_;
  std::uint64_t written_ = 0;
  std::string channels_;       // schema and channel records
  std::string chunk_indices_;  // of the chunks written
  Chunk chunk_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint32_t chunks_ = 0;
  std::uint64_t first_ns_ = UINT64_MAX;
  std::uint64_t last_ns_ = 0;
};

}  // namespace rilo::detail
