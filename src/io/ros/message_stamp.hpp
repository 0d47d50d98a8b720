// Stamps of the messages that we write.
#pragma once

#include <algorithm>
#include <cstdint>

#include "io/stamp_difference.hpp"

namespace rilo::detail {

struct MessageStamp {
  std::uint32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
};

/// The nearest stamp that a message can have: from `least_ns` (0 or later: no library of ROS takes a negative time) to
/// the end of the second `last_second`.
inline MessageStamp message_stamp(std::int64_t stamp_ns, std::int64_t least_ns, std::uint32_t last_second) {
  const std::int64_t last_ns = (std::int64_t{last_second} + 1) * kNanosecondsPerSecond - 1;
  const std::int64_t known = std::clamp(stamp_ns, least_ns, last_ns);
  return {static_cast<std::uint32_t>(known / kNanosecondsPerSecond),
          static_cast<std::uint32_t>(known % kNanosecondsPerSecond)};
}

/// s from the pose before results[i] to it, as the message's velocity covers it; 0 for the first.
template <typename Results>
double step_to(const Results& results, std::size_t i) {
  return i == 0 ? 0 : static_cast<double>(stamp_difference(results[i].stamp_ns, results[i - 1].stamp_ns)) * 1e-9;
}

}  // namespace rilo::detail
