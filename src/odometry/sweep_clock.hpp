// The odometry's own time: steps between sweeps, also where stamps are wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rilo {

/// Time of a sweep.
struct SweepTime {
  std::int64_t stamp_ns = 0;  ///< of the pose; increases from sweep to sweep
  std::int64_t step_ns = 0;   ///< time since the sweep before, > 0; 0 for the first
  std::int64_t even_ns = 0;   ///< the same for a sensor that spins evenly: a whole number of mean periods
};

/// Takes steps between stamps as they are where a sensor can have made them; elsewhere a period has passed. A stamp
/// that is alone in its error is forgotten with the next one, and a clock that was set is followed from then on.
class SweepClock {
 public:
  /// Time of the next sweep from the stamp of its middle, which lies `to_middle_ns` behind the one that it came with:
  /// that grows where later points are seen for the first time, which is no unevenness of the sensor.
  SweepTime advance(std::int64_t given_ns, std::int64_t to_middle_ns = 0);

  /// Median of the last believed steps (ns).
  std::int64_t period_ns() const;

  void reset() { *this = {}; }

 private:
  static constexpr std::size_t kRemembered = 32;  // steps: a few drops among them do not move their median

  void remember(std::int64_t step_ns);
  /// The last one of the remembered steps, if they were even.
  std::int64_t last_even_ns() const;

  bool begun_ = false;
  std::int64_t stamp_ns_ = 0;      // of the last pose
  std::int64_t given_ns_ = 0;      // the stamp that the last sweep came with, ...
  std::int64_t to_middle_ns_ = 0;  // ... and what of it is its middle
  std::int64_t believed_ns_ = 0;   // the last one that was believed, ...
  std::int64_t since_ns_ = 0;      // ... and the own time since then: 0 when it is that of the last sweep
  std::array<std::int64_t, kRemembered> steps_{};
  std::size_t count_ = 0;
};

}  // namespace rilo
