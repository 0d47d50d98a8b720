// Every key of the odometry's configuration.
#pragma once

#include "rilo/config/config_key.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// The keys of `config`, which must outlive them.
ConfigKeys odometry_keys(OdometryConfig& config);

}  // namespace rilo
