#include "io/lzf.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace rilo::detail {
namespace {

// A control byte below 32 is followed by that many + 1 literal bytes. Otherwise its upper three bits are the length - 2
// of a copy (7: another byte is added), its lower five bits and the following byte the distance - 1.
constexpr std::size_t kLongestLiteral = 32;
constexpr std::size_t kLongestCopy = 264;
constexpr std::size_t kLongestDistance = 8192;
constexpr std::size_t kShortestCopy = 3;

unsigned byte_at(std::string_view text, std::size_t place) { return static_cast<unsigned char>(text[place]); }

std::size_t hash_of(std::string_view input, std::size_t place) {
  const std::uint32_t key = byte_at(input, place) << 16 | byte_at(input, place + 1) << 8 | byte_at(input, place + 2);
  return (key * 2654435761U) >> 18;  // 14 bits
}

std::size_t match_length(std::string_view input, std::size_t candidate, std::size_t place) {
  const std::size_t longest = std::min(kLongestCopy, input.size() - place);
  std::size_t length = 0;
  while (length < longest && input[candidate + length] == input[place + length]) ++length;
  return length;
}

void append_literals(std::string& output, std::string_view literals) {
  while (!literals.empty()) {
    const std::size_t run = std::min(kLongestLiteral, literals.size());
    output += static_cast<char>(run - 1);
    output.append(literals.substr(0, run));
    literals.remove_prefix(run);
  }
}

void append_copy(std::string& output, std::size_t distance, std::size_t length) {
  const std::size_t coded = length - 2;
  const std::size_t far = distance - 1;
  output += static_cast<char>(std::min<std::size_t>(coded, 7) << 5 | far >> 8);
  if (coded >= 7) output += static_cast<char>(coded - 7);
  output += static_cast<char>(far & 0xFF);
}

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

std::string lzf_compress(std::string_view input) {
  std::string output;
  std::vector<std::size_t> last(std::size_t{1} << 14, static_cast<std::size_t>(-1));
  std::size_t literal_begin = 0;
  std::size_t place = 0;
  while (place + kShortestCopy <= input.size()) {
    std::size_t& slot = last[hash_of(input, place)];
    const std::size_t candidate = slot;
    slot = place;
    if (candidate == static_cast<std::size_t>(-1) || place - candidate > kLongestDistance) {
      ++place;
      continue;
    }
    const std::size_t length = match_length(input, candidate, place);
    if (length < kShortestCopy) {
      ++place;
      continue;
    }
    append_literals(output, input.substr(literal_begin, place - literal_begin));
    append_copy(output, place - candidate, length);
    place += length;
    literal_begin = place;
  }
  append_literals(output, input.substr(literal_begin));
  return output;
}

}  // namespace rilo::detail
