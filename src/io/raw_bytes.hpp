// Numbers as the bytes of a file, the lowest first unless `big_endian`.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace rilo::detail {

static_assert(std::endian::native == std::endian::little, "the formats are little-endian");

template <typename T>
void append_bytes(std::string& bytes, T value, bool big_endian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// The value at `place`, which must be inside.
template <typename T>
T load_bytes(std::string_view bytes, std::size_t place, bool big_endian = false) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data() + place, sizeof(T));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace rilo::detail
