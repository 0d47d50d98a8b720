// Wall time of a sweep and of its stages.
#pragma once

#include <cstdint>
#include <utility>

#include "registration/deadline.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo {

/// Reads all zeros without a clock.
class StageClock {
 public:
  explicit StageClock(Odometry::Clock clock) : clock_(std::move(clock)) {}

  explicit operator bool() const { return static_cast<bool>(clock_); }

  /// A sweep, and its first stage, begin.
  void begin() { begin_ns_ = lap_ns_ = now(); }

  /// Since begin().
  double total_ms() const { return static_cast<double>(now() - begin_ns_) * 1e-6; }

  /// So long after begin().
  Deadline deadline(double after_ms) const { return {clock_, begin_ns_ + static_cast<std::int64_t>(after_ms * 1e6)}; }

  /// Since begin() or the last call.
  double lap_ms() {
    const std::int64_t last = std::exchange(lap_ns_, now());
    return static_cast<double>(lap_ns_ - last) * 1e-6;
  }

 private:
  std::int64_t now() const { return clock_ ? clock_() : 0; }

  Odometry::Clock clock_;
  std::int64_t begin_ns_ = 0;
  std::int64_t lap_ns_ = 0;
};

}  // namespace rilo
