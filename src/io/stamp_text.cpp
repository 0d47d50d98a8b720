// Decimal seconds and int64 ns, exactly.
#include <algorithm>
#include <cctype>
#include <limits>

#include <fmt/format.h>

#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

constexpr std::int64_t kDecimals = 9;

// A decimal number taken apart: digits × 10^-decimals.
struct Decimal {
  bool negative = false;
  std::string digits;
  std::int64_t decimals = 0;
};

std::optional<Decimal> take_apart(std::string_view text) {
  constexpr std::int64_t kLargestExponent = 1000;
  Decimal result;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    result.negative = text[0] == '-';
    text.remove_prefix(1);
  }
  const std::size_t exponent_at = std::min(text.find_first_of("eE"), text.size());
  bool after_point = false;
  for (const char letter : text.substr(0, exponent_at)) {
    if (letter == '.' && !after_point) {
      after_point = true;
    } else if (std::isdigit(static_cast<unsigned char>(letter)) != 0) {
      result.digits += letter;
      result.decimals += after_point ? 1 : 0;
    } else {
      return std::nullopt;
    }
  }
  if (result.digits.empty()) return std::nullopt;
  if (exponent_at < text.size()) {
    const auto exponent = detail::parse_integer(text.substr(exponent_at + 1));
    if (!exponent || *exponent < -kLargestExponent || *exponent > kLargestExponent) return std::nullopt;
    result.decimals -= *exponent;
  }
  return result;
}

}  // namespace

std::string format_stamp(std::int64_t stamp_ns) {
  // Unsigned, since the most negative stamp has no positive counterpart.
  const auto bits = static_cast<std::uint64_t>(stamp_ns);
  const std::uint64_t size = stamp_ns < 0 ? 0 - bits : bits;
  return fmt::format("{}{}.{:09}", stamp_ns < 0 ? "-" : "", size / detail::kNanosecondsPerSecond,
                     size % detail::kNanosecondsPerSecond);
}

std::optional<std::int64_t> parse_stamp(std::string_view text) {
  auto number = take_apart(text);
  if (!number) return std::nullopt;
  // To whole ns: cut or add digits behind.
  const std::int64_t surplus = number->decimals - kDecimals;
  std::string& digits = number->digits;
  bool round_up = false;
  if (surplus > 0) {
    const auto length = static_cast<std::int64_t>(digits.size());
    round_up = surplus <= length && digits[static_cast<std::size_t>(length - surplus)] >= '5';
    digits.resize(static_cast<std::size_t>(std::max<std::int64_t>(length - surplus, 0)));
  } else {
    digits.append(static_cast<std::size_t>(-surplus), '0');
  }
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  std::uint64_t size = 0;
  for (const char digit : digits) {
    if (size > kLargest / 10) return std::nullopt;
    size = size * 10 + static_cast<std::uint64_t>(digit - '0');
  }
  size += round_up ? 1 : 0;
  if (size > kLargest) return std::nullopt;
  return number->negative ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
}

}  // namespace rilo
