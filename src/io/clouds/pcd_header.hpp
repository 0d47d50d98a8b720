// Header of a .pcd file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/clouds/cloud_columns.hpp"

namespace rilo::detail {

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kBinaryCompressed };

struct PcdHeader {
  std::vector<Field> fields;
  std::size_t points = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::size_t body_offset = 0;  ///< bytes
  std::size_t lines = 0;        ///< of the header

  std::size_t point_bytes() const;
};

/// @throws IoError with the line. Says nothing yet about whether the body has that many points.
PcdHeader parse_pcd_header(const std::filesystem::path& file, std::string_view text);

}  // namespace rilo::detail
