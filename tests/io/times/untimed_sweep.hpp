// A sweep without point times, to which tests give theirs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rilo/cloud/sweep.hpp"

namespace rilo::test {

inline constexpr std::size_t kSweepPoints = 1000;
inline constexpr std::int64_t kSweepStamp = 1'700'000'000'000'000'000;

inline Sweep sweep_of(std::size_t points = kSweepPoints) {
  Sweep sweep;
  sweep.stamp_ns = kSweepStamp;
  for (std::size_t i = 0; i < points; ++i) sweep.points.emplace_back(static_cast<float>(i) + 1, 2, 3);
  return sweep;
}

}  // namespace rilo::test
