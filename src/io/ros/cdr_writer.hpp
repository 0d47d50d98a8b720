// ROS 2 messages as bytes: little-endian CDR, the reverse of MessageCursor.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/raw_bytes.hpp"

namespace rilo::detail {

/// Values are aligned to their size, counted from the end of the four bytes that name the encoding.
class CdrWriter {
 public:
  template <typename T>
  CdrWriter& put(T value) {
    const std::size_t written = bytes_.size() - kEncapsulation;
    bytes_.append((sizeof(T) - written % sizeof(T)) % sizeof(T), '\0');
    append_bytes(bytes_, value);
    return *this;
  }

  CdrWriter& put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text);
    bytes_ += '\0';
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;
  std::string bytes_{"\x00\x01\x00\x00", kEncapsulation};  // little-endian plain CDR
};

}  // namespace rilo::detail
