// Whether a body can have moved so.
#pragma once

#include <optional>

#include "rilo/geometry/se3.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Whether a sensor that moved by `before` in `before_s` can have moved by `step` in the `step_s` since, within the
/// bounds and the noise of poses. Without `before` only speed and turn rate are bounded.
bool possible_motion(const SE3& step, double step_s, const std::optional<SE3>& before, double before_s,
                     const MotionBoundsConfig& config);

/// Whether a sensor can have changed its velocity like that in `dt_s`, within the bounds and what the noise of poses
/// does to the velocity during a sweep.
bool possible_change(const Vector6d& velocity_change, double dt_s, const MotionBoundsConfig& config);

}  // namespace rilo
