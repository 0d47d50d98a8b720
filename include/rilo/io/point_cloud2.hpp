// sensor_msgs/PointCloud2, as ROS 1 and ROS 2 put it into bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/io/cloud_reader.hpp"

namespace rilo {

/// How a message became bytes.
enum class MessageEncoding : std::uint8_t {
  kRos1,  ///< ROS 1: packed, little-endian
  kCdr,   ///< ROS 2: CDR with its four bytes of encapsulation
};

/// One of PointCloud2's `fields`.
struct PointField {
  std::string name;
  std::uint32_t offset = 0;   ///< bytes from the start of a point
  std::uint8_t datatype = 0;  ///< 1 … 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
  std::uint32_t count = 1;
};

/// The message; `data` looks into the bytes it was parsed from.
struct PointCloud2 {
  std::int64_t stamp_ns = 0;
  std::string frame_id;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;  ///< bytes
  std::uint32_t row_step = 0;    ///< bytes
  std::string_view data;
  bool is_dense = false;
};

/// `file` and `part` ("message 17 of /points") are for messages.
/// @throws IoError, with the byte, when the bytes are none.
PointCloud2 parse_point_cloud2(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                               const std::string& part = {});

/// Points, intensities, rings and times of an unordered or organised cloud, padded rows or not; NaN points are kept.
/// `time_field`: see SourceOptions::time_field.
/// @throws IoError: big-endian data, sizes that contradict each other, fields outside the point, no x, y, z.
RawCloud columns_of(const PointCloud2& message, const std::string& time_field, const std::filesystem::path& file,
                    const std::string& part = {});

}  // namespace rilo
