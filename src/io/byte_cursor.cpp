#include "io/byte_cursor.hpp"

#include <algorithm>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {

std::string byte_position(const BytesOrigin& origin, std::size_t offset) {
  return (origin.part.empty() ? "" : origin.part + ", ") + "byte " + std::to_string(offset);
}

std::string_view ByteCursor::take_bytes(std::size_t count, const char* what) {
  if (count > left()) {
    throw IoError({origin_.file, position(), "the end after " + counted(left(), "byte"),
                   counted(count, "byte") + " of " + what, "It is cut off or damaged: copy or record it again"});
  }
  const std::string_view taken = bytes_.substr(offset_, count);
  offset_ += count;
  return taken;
}

void ByteCursor::align(std::size_t size) {
  const std::size_t past = offset_ % size;
  if (past != 0) offset_ = std::min(offset_ + size - past, bytes_.size());
}

}  // namespace rilo::detail
