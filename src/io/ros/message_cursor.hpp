// The values of a ROS message in their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/byte_cursor.hpp"
#include "rilo/io/point_cloud2.hpp"

namespace rilo::detail {

/// The encodings differ in alignment and in the end of strings.
class MessageCursor {
 public:
  /// @throws IoError when `bytes` should be CDR and have no encapsulation of little-endian CDR or XCDR2.
  MessageCursor(std::string_view bytes, MessageEncoding encoding, const BytesOrigin& origin)
      : largest_alignment_(encoding == MessageEncoding::kCdr ? alignment_of(bytes, origin) : 1),
        cursor_(cdr() ? bytes.substr(kEncapsulation) : bytes, origin, cdr() ? kEncapsulation : 0) {}

  template <typename T>
  T take(const char* what) {
    cursor_.align(std::min(sizeof(T), largest_alignment_));
    return cursor_.take<T>(what);
  }
  std::string_view take_bytes(std::size_t count, const char* what) { return cursor_.take_bytes(count, what); }
  std::string_view take_sequence(const char* what) {
    const auto size = take<std::uint32_t>(what);
    return cursor_.take_bytes(size, what);
  }
  std::string take_string(const char* what) {
    std::string_view text = take_sequence(what);
    if (cdr() && !text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }

  bool cdr() const { return largest_alignment_ > 1; }
  const ByteCursor& place() const { return cursor_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  static std::size_t alignment_of(std::string_view bytes, const BytesOrigin& origin);

  std::size_t largest_alignment_;  ///< 1: the values follow each other (ROS 1)
  ByteCursor cursor_;
};

/// std_msgs/Header.
struct MessageHeaderFields {
  std::int64_t stamp_ns = 0;
  std::string frame_id;
};
MessageHeaderFields take_header(MessageCursor& cursor);

/// Seconds and nanoseconds: unsigned in ROS 1, signed seconds in ROS 2.
std::int64_t take_stamp_ns(MessageCursor& cursor);

/// The length of a sequence whose items take `least_item_bytes` each at least. @throws IoError when the bytes that
/// follow cannot hold it; `what` names the items and `type` the message.
std::size_t take_count(MessageCursor& cursor, std::size_t least_item_bytes, const char* what, const char* type);

}  // namespace rilo::detail
