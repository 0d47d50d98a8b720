// What another pass over the same sweeps has found about the motion.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// The velocity of the sensor at a time.
struct KnownVelocity {
  Vector6d twist = Vector6d::Zero();  ///< [ω; v], rad/s and m/s, sensor frame
  double at_s = 0;                    ///< after the first sweep
};

}  // namespace rilo
