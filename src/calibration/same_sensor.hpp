// Whether known angles are those of the sensor that a sweep comes from.
#pragma once

#include <optional>
#include <string>

#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/cloud/sweep.hpp"

namespace rilo {

/// What speaks against it, a sentence; empty: nothing. Compares the elevations of the beams that both have. None: the
/// sweep has too few points to say.
std::optional<std::string> other_sensor(const SensorAngles& known, const SweepView& sweep);

}  // namespace rilo
