// Angles of a sensor to and from YAML: calibration.yaml among the results of a run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "rilo/calibration/sensor_angles.hpp"

namespace rilo {

/// @throws ConfigError with line and column: no YAML, unknown, repeated or missing keys, no numbers, angles that no
/// calibration finds, a beam twice.
SensorAngles load_calibration(const std::filesystem::path& file);

/// The same from text; `name` is the file's name in messages.
SensorAngles parse_calibration(std::string_view yaml, const std::string& name);

/// YAML, to 10⁻⁶ degrees. `source`: what the angles were learnt from, for the reader.
std::string dump_calibration(const SensorAngles& angles, const std::string& source);

}  // namespace rilo
