// Arithmetic of stamps that may be anything: damaged files have them, too.
#pragma once

#include <cmath>
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

/// From `begin_ns` to `end_ns`.
inline double seconds_between(std::int64_t begin_ns, std::int64_t end_ns) {
  return static_cast<double>(stamp_difference(end_ns, begin_ns)) * 1e-9;
}

inline std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

}  // namespace rilo::detail
