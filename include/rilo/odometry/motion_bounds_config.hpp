#pragma once

namespace rilo {

/// How a sensor can move at most, on a vehicle or in a hand. A registration that says more is not believed.
struct MotionBoundsConfig {
  double max_speed_m_s = 60.0;
  double max_acceleration_m_s2 = 30.0;  ///< a braking car has 10, an arm that jerks a sensor up to 30
  double max_turn_rate_rad_s = 10.0;
  double max_angular_acceleration_rad_s2 = 50.0;
};

}  // namespace rilo
