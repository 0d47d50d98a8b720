// Arithmetic of stamps that may be anything: damaged files have them, too.
#pragma once

#include <cstdint>
#include <limits>

namespace rilo::detail {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// a − b, or the largest number of that sign.
inline std::int64_t stamp_difference(std::int64_t a, std::int64_t b) {
  std::int64_t difference = 0;
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  if (!__builtin_sub_overflow(a, b, &difference) && difference >= -kMost) return difference;
  return a < b ? -kMost : kMost;
}

}  // namespace rilo::detail
