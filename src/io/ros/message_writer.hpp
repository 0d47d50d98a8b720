// The values of a ROS message as bytes, the reverse of MessageCursor.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/raw_bytes.hpp"
#include "io/ros/ros_values.hpp"
#include "rilo/io/point_cloud2.hpp"

namespace rilo::detail {

/// Little-endian. CDR aligns values to their size, counted from the end of the four bytes that name the encoding, and
/// ends strings with a zero.
class MessageWriter {
 public:
  explicit MessageWriter(MessageEncoding encoding)
      : cdr_(encoding == MessageEncoding::kCdr), bytes_(cdr_ ? std::string("\x00\x01\x00\x00", kEncapsulation) : "") {}

  template <typename T>
  void put(T value) {
    if (cdr_) bytes_.append((sizeof(T) - (bytes_.size() - kEncapsulation) % sizeof(T)) % sizeof(T), '\0');
    append_bytes(bytes_, value);
  }

  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + (cdr_ ? 1 : 0)));
    bytes_.append(text);
    if (cdr_) bytes_ += '\0';
  }

  /// std_msgs/Header; `number` is ROS 1's alone. Stamps that it cannot have become the nearest one.
  void put_header(std::uint32_t number, std::int64_t stamp_ns, std::string_view frame) {
    if (!cdr_) put(number);
    const MessageStamp stamp = message_stamp(stamp_ns, 0, cdr_ ? kLastRos2Second : kLastRos1Second);
    put(stamp.seconds);
    put(stamp.nanoseconds);
    put_text(frame);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  bool cdr_;
  std::string bytes_;
};

}  // namespace rilo::detail
