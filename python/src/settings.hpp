// The odometry's configuration from Python objects.
#pragma once

#include <optional>
#include <pybind11/pybind11.h>

#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo::python {

/// `config`: None, a dict, YAML text, or the path of a YAML file (what ends in .yaml or .yml, or any os.PathLike).
/// `settings`, on top of it: None, a dict (nested, or with dotted keys), or a sequence of "key=value".
/// @throws ConfigError for what the configuration rejects; TypeError for values that no key can take.
OdometryConfig config_of(const pybind11::object& config, const pybind11::object& settings);

/// `calibration`: None, YAML text, or the path of a YAML file, as config_of() tells them apart.
/// @throws ConfigError, TypeError
std::optional<SensorAngles> calibration_of(const pybind11::object& calibration);

}  // namespace rilo::python
