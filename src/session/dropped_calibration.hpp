// Whether what was known of a sensor counts.
#pragma once

#include <string>

#include "rilo/calibration/sensor_angles.hpp"

namespace rilo {

/// A sentence when the known elevation offset does not count, because the one that was found lies farther off than
/// `significance` of its standard deviations. Empty otherwise: both are averaged, and an average lies nearer.
std::string dropped_calibration(const SensorAngles& known, const SensorAngles& found, double significance);

}  // namespace rilo
