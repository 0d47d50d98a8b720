// Whether known angles are those of the sensor that sweeps come from, and of data that were read as they are.
#pragma once

#include <optional>
#include <string>

#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/cloud/sweep.hpp"

namespace rilo {

/// What speaks against it, a sentence; empty: nothing. Compares the elevations of the beams that both have. None: the
/// sweep has too few points to say.
std::optional<std::string> other_sensor(const SensorAngles& known, const SweepView& sweep);

/// @throws std::invalid_argument when the elevation correction of the data is not that which the angles come on top of.
void check_reading(const SensorAngles& known, double elevation_correction_deg);

/// Of the file, to begin a message with.
std::string name_of(const SensorAngles& known);

}  // namespace rilo
