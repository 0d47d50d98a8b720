// Raw or compensated, by the cones of a sensor's beams.
#pragma once

#include <cstdint>

#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/se3.hpp"

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

}  // namespace rilo
