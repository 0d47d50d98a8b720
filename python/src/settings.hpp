// The odometry's configuration from Python objects.
#pragma once

#include <pybind11/pybind11.h>

#include "rilo/odometry/odometry_config.hpp"

namespace rilo::python {

/// `config`: None, a dict, YAML text, or the path of a YAML file (what ends in .yaml or .yml, or any os.PathLike).
/// `settings`, on top of it: None, a dict (nested, or with dotted keys), or a sequence of "key=value".
/// @throws ConfigError for what the configuration rejects; TypeError for values that no key can take.
OdometryConfig config_of(const pybind11::object& config, const pybind11::object& settings);

}  // namespace rilo::python
