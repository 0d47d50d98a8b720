#include "io/ros/message_cursor.hpp"

#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {

// The low bit of the kind says little-endian; XCDR2 aligns to four bytes at most.
std::size_t MessageCursor::alignment_of(std::string_view bytes, const BytesOrigin& origin) {
  ByteCursor cursor(bytes, origin);
  const std::string_view kind = cursor.take_bytes(kEncapsulation, "encapsulation");
  if (kind[0] == 0 && kind[1] == 1) return 8;
  if (kind[0] == 0 && kind[1] == 7) return 4;
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) {
    throw IoError(
        {origin.file, byte_position(origin, 0), "a message in zstd", "0 1 (CDR, little-endian)",
         "Restore the recording's metadata.yaml, which says that its messages are packed (ros2 bag reindex)"});
  }
  throw IoError({origin.file, byte_position(origin, 0),
                 "an encapsulation of " + std::to_string(static_cast<unsigned char>(kind[0])) + " " +
                     std::to_string(static_cast<unsigned char>(kind[1])),
                 "0 1 (CDR, little-endian)", "Record on a little-endian machine, or check the message's type"});
}

std::int64_t take_stamp_ns(MessageCursor& cursor) {
  const auto seconds = cursor.take<std::uint32_t>("stamp");
  const std::int64_t whole = cursor.cdr() ? std::int64_t{static_cast<std::int32_t>(seconds)} : std::int64_t{seconds};
  return whole * kNanosecondsPerSecond + cursor.take<std::uint32_t>("stamp");
}

MessageHeaderFields take_header(MessageCursor& cursor) {
  if (!cursor.cdr()) cursor.take<std::uint32_t>("sequence number");
  MessageHeaderFields header;
  header.stamp_ns = take_stamp_ns(cursor);
  header.frame_id = cursor.take_string("frame_id");
  return header;
}

std::size_t take_count(MessageCursor& cursor, std::size_t least_item_bytes, const char* what, const char* type) {
  const auto count = cursor.take<std::uint32_t>(what);
  if (count <= cursor.place().left() / least_item_bytes) return count;
  throw IoError({cursor.place().origin().file, cursor.place().position(), std::to_string(count) + " " + what,
                 "at most what the " + counted(cursor.place().left(), "byte") + " that follow can hold",
                 std::string("The message is damaged, or is not a ") + type});
}

}  // namespace rilo::detail
