// Raw or compensated, by the cones of a sensor's beams.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// What the elevation angles of a sweep's points say of them.
enum class ConeVerdict : std::uint8_t {
  kNothing,  ///< turned mostly, hardly moved, few points near by, or not in the frame of a sensor that turns about z
  kRaw,      ///< on the cones of the beams
  kCompensated,  ///< on them once the compensation is undone
};

/// Each beam of a sensor that turns about its z axis draws a cone: raw points have few elevation angles. Compensation
/// for the sensor's way takes them off the cones. `sweep` has times; `twist`: velocity of the sensor [rad/s; m/s]. The
/// pose that a compensation referred to may be at the begin, the middle or the end of the sweep.
ConeVerdict on_beam_cones(const Sweep& sweep, const Vector6d& twist);

/// The verdicts on the first sweeps of a run.
class ConeVotes {
 public:
  /// More sweeps count.
  bool open() const;
  /// A sweep was registered. It counts when it has times and the sensor moved within the `turn_s` of a turn.
  void add(const Sweep& sweep, const SweepResult& result, double turn_s);
  /// Nine of the first ten that say something are compensated, although they have times.
  bool compensated() const;

 private:
  std::size_t looked_at_ = 0;
  std::size_t raw_ = 0;
  std::size_t compensated_ = 0;
};

}  // namespace rilo
