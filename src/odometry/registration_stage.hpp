// Fine registration of a sweep from its initial pose (III-D), the second sweep of a map and doubtful fits included.
#pragma once

#include "odometry/registration.hpp"

namespace rilo {

/// Registers the sweep to the map from its initial pose, with the predicted velocity unless the sweep has refuted that.
/// The second sweep of a map and one that fits badly are tried from other places, too.
Registration fine_registration(const RegistrationContext& context, const MotionState& predicted,
                               const InitialPose& init);

}  // namespace rilo
