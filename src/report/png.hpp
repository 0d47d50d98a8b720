// A picture as text that HTML can hold.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rilo {

using Rgba = std::array<std::uint8_t, 4>;

/// An indexed picture: `pixels` row by row from the top, each an index into `palette` (at most 256 entries).
struct IndexedImage {
  int width = 0;
  int height = 0;
  std::vector<Rgba> palette;
  std::vector<std::uint8_t> pixels;
};

/// The picture as PNG in a data URL. @throws std::runtime_error when libpng fails.
std::string png_data_url(const IndexedImage& image);

/// Base64 (RFC 4648, with padding).
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace rilo
