#include "io/ros/ros_bytes.hpp"

#include <lz4frame.h>
#include <map>
#include <sqlite3.h>
#include <stdexcept>
#include <zlib.h>
#include <zstd.h>

namespace rilo::test {
namespace {

std::string record(std::uint8_t opcode, const std::string& content) {
  return Bytes().put(opcode).put(std::uint64_t{content.size()}).raw(content).text;
}

std::string schema_record(std::size_t index, const std::string& type, const McapShape& shape) {
  const auto id = static_cast<std::uint16_t>(index + 1);
  const std::string kind = shape.encoding == "ros1" ? "ros1msg" : "ros2msg";
  return record(3, Bytes().put(id).string(type).string(kind).sequence("text").text);
}

std::string channel_record(std::size_t index, const std::string& name, const McapShape& shape) {
  const auto id = static_cast<std::uint16_t>(index + 1);
  return record(4, Bytes().put(id).put(id).string(name).string(shape.encoding).put(std::uint32_t{0}).text);
}

std::string chunk_record(const std::string& content, const McapShape& shape) {
  const std::string packed = shape.compression == "zstd"  ? zstd_of(content)
                             : shape.compression == "lz4" ? lz4_of(content)
                                                          : content;
  const auto crc = ::crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
  Bytes chunk;
  chunk.put(std::uint64_t{0}).put(std::uint64_t{0}).put(std::uint64_t{content.size()});
  chunk.put(static_cast<std::uint32_t>(crc)).string(shape.compression);
  chunk.put(std::uint64_t{packed.size()}).raw(packed);
  return record(6, chunk.text);
}

std::uint16_t channel_of(const Topics& topics, const std::string& name) {
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].first == name) return static_cast<std::uint16_t>(i + 1);
  }
  throw std::logic_error("no such topic");
}

// Chunk index: which channels have messages in the chunk.
std::string index_record(std::uint64_t offset, const std::map<std::uint16_t, std::uint64_t>& channels) {
  Bytes offsets;
  for (const auto& [id, count] : channels) offsets.put(id).put(std::uint64_t{0});
  Bytes index;
  index.put(std::uint64_t{0}).put(std::uint64_t{0}).put(offset).put(std::uint64_t{0}).sequence(offsets.text);
  index.put(std::uint64_t{0}).string("").put(std::uint64_t{0}).put(std::uint64_t{0});
  return record(8, index.text);
}

// Behind a chunk: a time and an offset for each of its messages.
std::string message_index_records(const std::map<std::uint16_t, std::uint64_t>& channels) {
  std::string records;
  for (const auto& [id, count] : channels) {
    records += record(7, Bytes().put(id).sequence(std::string(count * 16, '\0')).text);
  }
  return records;
}

std::string statistics_record(const std::map<std::uint16_t, std::uint64_t>& counts) {
  Bytes pairs;
  for (const auto& [id, count] : counts) pairs.put(id).put(count);
  return record(0x0B, Bytes().raw(std::string(42, '\0')).sequence(pairs.text).text);
}

}  // namespace

std::string zstd_of(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

std::string lz4_of(std::string_view bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

std::string mcap_bytes(const Topics& topics, const std::vector<Recorded>& messages, const McapShape& shape) {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string about;
  std::string repeated;  // in the summary
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const std::string schema = schema_record(i, topics[i].second, shape);
    const std::string channel = channel_record(i, topics[i].first, shape);
    about += schema + channel;
    repeated += (shape.left_out.empty() ? schema : "") + (shape.left_out == "channels" ? "" : channel);
  }
  std::string file = magic + record(1, Bytes().string(shape.encoding == "ros1" ? "ros1" : "ros2").string("test").text);
  if (shape.chunk_messages == 0) file += about;
  std::map<std::uint16_t, std::uint64_t> counts;
  std::map<std::uint16_t, std::uint64_t> in_chunk;
  std::string chunk = about;
  std::string indices;
  std::size_t waiting = 0;
  const auto close_chunk = [&] {
    indices += index_record(file.size(), in_chunk);
    file += chunk_record(chunk, shape);
    if (shape.message_index) file += message_index_records(in_chunk);
    chunk.clear();
    in_chunk.clear();
    waiting = 0;
  };
  for (const Recorded& message : messages) {
    const std::uint16_t id = channel_of(topics, message.topic);
    const auto stamp = static_cast<std::uint64_t>(message.received_ns);
    const std::string bytes =
        record(5, Bytes().put(id).put(std::uint32_t{0}).put(stamp).put(stamp).raw(message.bytes).text);
    ++counts[id];
    ++in_chunk[id];
    if (shape.chunk_messages == 0) {
      file += bytes;
    } else {
      chunk += bytes;
      if (++waiting == shape.chunk_messages) close_chunk();
    }
  }
  if (waiting > 0) close_chunk();
  file += record(0x0F, Bytes().put(std::uint32_t{0}).text);
  const std::uint64_t summary = shape.summary ? file.size() : 0;
  if (shape.summary) file += repeated + statistics_record(counts) + indices;
  return file + record(2, Bytes().put(summary).put(std::uint64_t{0}).put(std::uint32_t{0}).text) + magic;
}

void write_db3(const std::filesystem::path& file, const Topics& topics, const std::vector<Recorded>& messages,
               const std::string& serialization_format) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  const auto run = [&](const std::string& sql) {
    if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) throw std::logic_error(sql);
  };
  run("PRAGMA synchronous = OFF");  // no message waits for the disk
  run("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL)");
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT "
      "NULL,offered_qos_profiles TEXT NOT NULL)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,data BLOB NOT "
      "NULL)");
  run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  for (std::size_t i = 0; i < topics.size(); ++i) {
    run("INSERT INTO topics VALUES (" + std::to_string(i + 1) + ", '" + topics[i].first + "', '" + topics[i].second +
        "', '" + serialization_format + "', '')");
  }
  for (const Recorded& message : messages) {
    sqlite3_stmt* row = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", -1, &row,
                       nullptr);
    sqlite3_bind_int(row, 1, channel_of(topics, message.topic));
    sqlite3_bind_int64(row, 2, message.received_ns);
    sqlite3_bind_blob(row, 3, message.bytes.data(), static_cast<int>(message.bytes.size()), SQLITE_STATIC);
    sqlite3_step(row);
    sqlite3_finalize(row);
  }
  sqlite3_close(database);
}

std::string metadata_yaml(const std::vector<std::string>& files, const std::string& storage,
                          const std::string& compression_mode) {
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: " + storage +
                     "\n  duration:\n    nanoseconds: 400000000\n  message_count: 5\n  compression_format: \"" +
                     (compression_mode.empty() ? "" : "zstd") + "\"\n  compression_mode: \"" + compression_mode +
                     "\"\n  relative_file_paths:\n";
  for (const std::string& file : files) text += "    - " + file + "\n";
  return text;
}

std::vector<Sweep> numbered_sweeps(std::size_t count, std::size_t points) {
  std::vector<Sweep> sweeps(count);
  for (std::size_t i = 0; i < count; ++i) {
    sweeps[i].stamp_ns = 1'700'000'000'250'000'000 + static_cast<std::int64_t>(i) * 100'000'000;
    for (std::size_t k = 0; k < points; ++k) {
      sweeps[i].points.emplace_back(static_cast<float>(i) + 0.1F, static_cast<float>(k) - 3.7F, 1.3F);
      sweeps[i].intensities.push_back(static_cast<float>(k) * 0.3F);
      sweeps[i].times_s.push_back(0.0999F * static_cast<float>(k) / static_cast<float>(points - 1));
      sweeps[i].rings.push_back(static_cast<std::uint16_t>(k % 16));
    }
  }
  return sweeps;
}

}  // namespace rilo::test
