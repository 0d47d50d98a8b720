// PointCloud2 messages and the containers they come in, made byte by byte.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/io/point_cloud2.hpp"

namespace rilo::test {

/// Appends values as they lie in memory; with `cdr`, each at a multiple of its size.
class Bytes {
 public:
  explicit Bytes(bool cdr = false) : cdr_(cdr) {}

  template <typename T>
  Bytes& put(T value) {
    if (cdr_) text.resize((text.size() + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    text.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  Bytes& raw(std::string_view bytes) {
    text += bytes;
    return *this;
  }
  /// A string with its length; CDR counts the final zero.
  Bytes& string(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + (cdr_ ? 1 : 0)));
    raw(value);
    if (cdr_) text += '\0';
    return *this;
  }
  Bytes& sequence(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    return raw(bytes);
  }

  std::string text;

 private:
  bool cdr_;
};

/// A PointCloud2 as a driver would fill it.
struct CloudMessage {
  std::int64_t stamp_ns = 0;
  std::string frame_id = "lidar";
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::string data;
  bool big_endian = false;
};

/// The fields of std_msgs/Header.
inline void put_header(Bytes& bytes, bool ros1, std::int64_t stamp_ns, const std::string& frame_id) {
  if (ros1) bytes.put(std::uint32_t{7});
  bytes.put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
  bytes.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)).string(frame_id);
}
inline std::string finished(const Bytes& bytes, bool ros1) {
  return (ros1 ? "" : std::string("\0\1\0\0", 4)) + bytes.text;
}

inline std::string message_bytes(const CloudMessage& m, MessageEncoding encoding) {
  const bool ros1 = encoding == MessageEncoding::kRos1;
  Bytes bytes(!ros1);
  put_header(bytes, ros1, m.stamp_ns, m.frame_id);
  bytes.put(m.height).put(m.width).put(static_cast<std::uint32_t>(m.fields.size()));
  for (const PointField& field : m.fields) {
    bytes.string(field.name).put(field.offset).put(field.datatype).put(field.count);
  }
  bytes.put(static_cast<std::uint8_t>(m.big_endian)).put(m.point_step).put(m.row_step);
  bytes.sequence(m.data).put(std::uint8_t{0});
  return finished(bytes, ros1);
}

/// x y z intensity time ring of a sweep, in points of 24 bytes (the ring is followed by two of padding).
inline CloudMessage message_of(const Sweep& sweep) {
  constexpr std::uint8_t kUint16 = 4;
  constexpr std::uint8_t kFloat32 = 7;
  CloudMessage m;
  m.stamp_ns = sweep.stamp_ns;
  m.width = static_cast<std::uint32_t>(sweep.points.size());
  m.fields = {{"x", 0, kFloat32, 1}, {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1}, {"intensity", 12, kFloat32, 1}};
  if (!sweep.times_s.empty()) m.fields.push_back({"time", 16, kFloat32, 1});
  if (!sweep.rings.empty()) m.fields.push_back({"ring", 20, kUint16, 1});
  m.point_step = 24;
  m.row_step = m.point_step * m.width;
  Bytes bytes;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) bytes.put(sweep.points[i][axis]);
    bytes.put(sweep.intensities.empty() ? 0.0F : sweep.intensities[i]);
    bytes.put(sweep.times_s.empty() ? 0.0F : sweep.times_s[i]);
    bytes.put(sweep.rings.empty() ? std::uint16_t{0} : sweep.rings[i]).put(std::uint16_t{0});
  }
  m.data = bytes.text;
  return m;
}

/// One message of a recording to be.
struct Recorded {
  std::string topic;
  std::int64_t received_ns = 0;
  std::string bytes;
};
using Topics = std::vector<std::pair<std::string, std::string>>;  // name, type

inline constexpr const char* kRos1Type = "sensor_msgs/PointCloud2";
inline constexpr const char* kRos2Type = "sensor_msgs/msg/PointCloud2";

/// Messages of the sweeps on /points, recorded 10 ms after their stamps.
inline std::vector<Recorded> recorded(const std::vector<Sweep>& sweeps, MessageEncoding encoding) {
  std::vector<Recorded> messages;
  for (const Sweep& sweep : sweeps) {
    messages.push_back({"/points", sweep.stamp_ns + 10'000'000, message_bytes(message_of(sweep), encoding)});
  }
  return messages;
}

struct McapShape {
  std::string compression = {};    ///< "", zstd, lz4
  std::size_t chunk_messages = 2;  ///< 0: no chunks
  bool summary = true;
  std::string encoding = "cdr";
  std::string left_out = {};   ///< of the summary: "schemas", or "channels" (and schemas)
  bool message_index = false;  ///< behind each chunk
};
std::string mcap_bytes(const Topics& topics, const std::vector<Recorded>& messages, const McapShape& shape);

/// As the recorder of ROS 2 writes it.
void write_db3(const std::filesystem::path& file, const Topics& topics, const std::vector<Recorded>& messages,
               const std::string& serialization_format = "cdr");

/// metadata.yaml of a rosbag2 folder.
std::string metadata_yaml(const std::vector<std::string>& files, const std::string& storage,
                          const std::string& compression_mode = "");

std::string zstd_of(std::string_view bytes);
std::string lz4_of(std::string_view bytes);

/// "none", "bz2" or "lz4". Only where the build has librosbag-storage.
void write_bag(const std::filesystem::path& file, const Topics& topics, const std::vector<Recorded>& messages,
               const std::string& compression = "none");

/// Sweeps of `points` points each, 0.1 s apart from 1700000000.25 s on, with all columns.
std::vector<Sweep> numbered_sweeps(std::size_t count, std::size_t points = 30);

}  // namespace rilo::test
