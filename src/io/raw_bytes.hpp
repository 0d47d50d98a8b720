// Numbers as the bytes of a file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace rilo::detail {

/// Appends the bytes of `value`, the lowest first by default.
template <typename T>
void append_bytes(std::string& bytes, T value, bool big_endian = false) {
  static_assert(std::endian::native == std::endian::little, "the formats are little-endian");
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace rilo::detail
