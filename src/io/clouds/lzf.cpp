#include "io/clouds/lzf.hpp"

#include <cstring>

namespace rilo::detail {
namespace {

// A control byte below 32 is followed by that many + 1 literal bytes. Otherwise its upper three bits are the length - 2
// of a copy (7: another byte is added), its lower five bits and the following byte the distance - 1.
constexpr std::size_t kLongestLiteral = 32;

unsigned byte_at(std::string_view text, std::size_t place) { return static_cast<unsigned char>(text[place]); }

}  // namespace

std::optional<std::size_t> lzf_decompress(std::string_view input, std::span<char> output) {
  std::size_t in = 0;
  std::size_t out = 0;
  while (in < input.size()) {
    const std::size_t begin = in;
    const unsigned control = byte_at(input, in++);
    if (control < kLongestLiteral) {
      const std::size_t run = control + 1;
      if (run > input.size() - in || run > output.size() - out) return begin;
      std::memcpy(output.data() + out, input.data() + in, run);
      in += run;
      out += run;
      continue;
    }
    std::size_t length = control >> 5;
    if (in + (length == 7 ? 2 : 1) > input.size()) return begin;
    if (length == 7) length += byte_at(input, in++);
    length += 2;
    const std::size_t distance = (std::size_t{control & 31} << 8 | byte_at(input, in++)) + 1;
    if (distance > out || length > output.size() - out) return begin;
    // Byte by byte: source and target may overlap, which repeats a pattern.
    for (std::size_t i = 0; i < length; ++i, ++out) output[out] = output[out - distance];
  }
  if (out != output.size()) return in;
  return std::nullopt;
}

}  // namespace rilo::detail
