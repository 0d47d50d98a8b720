// Livox' CustomMsg: of livox_ros_driver and livox_ros_driver2, in ROS 1 and ROS 2 the same fields.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/point_cloud2.hpp"

namespace rilo::detail {

struct LivoxMessage {
  std::int64_t stamp_ns = 0;  ///< of the header
  std::string frame_id;
  /// m; reflectivities 0 … 255, the lines as rings, `offset_time` in ns since the stamp. Points without a return are
  /// at the origin.
  RawCloud cloud;
};

/// `file` and `part` ("message 17 of /livox/lidar") are for messages.
/// @throws IoError, with the byte, when the bytes are not a CustomMsg.
LivoxMessage parse_livox(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                         const std::string& part);

}  // namespace rilo::detail
