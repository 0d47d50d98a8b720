// Timestamps as a driver gives them, sweep by sweep.
#pragma once

#include <cstdint>
#include <optional>

#include "rilo/cloud/sweep.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::python {

/// Step between sweeps without stamps.
inline constexpr double kAssumedPeriodS = 0.1;

/// A PointTimeDecoder that sees no sweep ahead. Times of a clock that has just begun, as simulated ones do, look like
/// those since the start of the sweep: it takes their stamp, or the second sweep, to tell.
class FrameTimes {
 public:
  /// Sets times and, where they are of a clock, the stamp of `sweep`. `stamp_ns`: what the caller says it is.
  /// @throws IoError as PointTimeDecoder.
  void decode(const RawTimes& raw, PointTimeUnit unit, const std::optional<std::int64_t>& stamp_ns, Sweep& sweep);

  void forget();

 private:
  void decode_near_zero(const RawTimes& raw, const std::optional<std::int64_t>& stamp_ns, Sweep& sweep);

  std::optional<PointTimeDecoder> decoder_;
  PointTimeUnit unit_ = PointTimeUnit::kInfer;
  std::optional<std::int64_t> first_end_ns_;  ///< last time of the first sweep, as long as it is not told
};

}  // namespace rilo::python
