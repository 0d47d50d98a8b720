#pragma once

namespace rilo {

/// Prior of the registration from the motion so far (white noise on acceleration).
struct MotionPriorConfig {
  bool enabled = true;                       ///< false: the sweep alone decides, as in the paper
  double acceleration_m_s2 = 10.0;           ///< usual change of velocity within a tenth of a second, per second
  double angular_acceleration_rad_s2 = 2.0;  ///< the same of the turn rate
  double unseen_share = 0.1;                 ///< of both that counts after a degenerate sweep
};

}  // namespace rilo
