// Walks through bytes of a known layout and says where they end too early.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/raw_bytes.hpp"

namespace rilo::detail {

/// Where bytes come from, for messages: a file, and the part of it that is looked into.
struct BytesOrigin {
  std::filesystem::path file;
  std::string part = {};  ///< "message 17 of /points"; empty: the file itself
};

/// "message 17 of /points, byte 24", or "byte 24" when the origin is a whole file.
std::string byte_position(const BytesOrigin& origin, std::size_t offset);

/// Little-endian values one after the other. Nothing is copied.
class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, const BytesOrigin& origin, std::size_t base = 0)
      : bytes_(bytes), origin_(origin), base_(base) {}

  /// @throws IoError when the bytes end first; `what` is named in the message.
  template <typename T>
  T take(const char* what) {
    return load_bytes<T>(take_bytes(sizeof(T), what), 0);
  }
  std::string_view take_bytes(std::size_t count, const char* what);

  /// A length of 32 bits and that many bytes.
  std::string_view take_text(const char* what) { return take_bytes(take<std::uint32_t>(what), what); }

  /// To the next multiple of `size` from the first byte.
  void align(std::size_t size);

  bool at_end() const { return offset_ == bytes_.size(); }
  std::size_t offset() const { return offset_; }
  std::size_t left() const { return bytes_.size() - offset_; }
  std::string position() const { return byte_position(origin_, base_ + offset_); }
  const BytesOrigin& origin() const { return origin_; }

 private:
  std::string_view bytes_;
  const BytesOrigin& origin_;
  std::size_t base_;
  std::size_t offset_ = 0;
};

}  // namespace rilo::detail
