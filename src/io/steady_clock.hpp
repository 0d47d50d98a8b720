// The clock of everything that measures its own time.
#pragma once

#include <chrono>
#include <cstdint>

namespace rilo {

/// Monotonic time, ns; only differences have a meaning. Fits Odometry::Clock.
inline std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace rilo
