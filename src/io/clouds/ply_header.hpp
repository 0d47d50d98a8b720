// Header of a .ply file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/clouds/cloud_columns.hpp"

namespace rilo::detail {

enum class PlyEncoding : std::uint8_t { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::optional<ScalarType> list_count;  ///< set: a list, with this type of its length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// A list is not a column: its name must not be taken for one.
  std::vector<Field> fields() const;
  bool has_list() const;
  /// Bytes of a row; with lists: of a row whose lists are empty.
  std::size_t least_bytes() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t body_offset = 0;  ///< bytes
  std::size_t lines = 0;        ///< of the header
};

/// @throws IoError with the line. Says nothing yet about whether the body has that many rows.
PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view text);

}  // namespace rilo::detail
