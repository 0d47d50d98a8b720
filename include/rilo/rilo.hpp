// The odometry: sweeps in, poses and a local map out. What lies around it has headers and components of its own: files
// (rilo/io), a whole run in two passes (rilo/session), configuration files (rilo/config), errors against a ground truth
// (rilo/evaluation), simulated drives (rilo/simulation).
#pragma once

#include "rilo/calibration/sensor_angles.hpp"  // IWYU pragma: export
#include "rilo/cloud/sweep.hpp"                // IWYU pragma: export
#include "rilo/cloud/thinned_map.hpp"          // IWYU pragma: export
#include "rilo/geometry/se3.hpp"               // IWYU pragma: export
#include "rilo/geometry/trajectory.hpp"        // IWYU pragma: export
#include "rilo/odometry/odometry.hpp"          // IWYU pragma: export
#include "rilo/odometry/odometry_config.hpp"   // IWYU pragma: export
#include "rilo/odometry/sweep_result.hpp"      // IWYU pragma: export
