// How closely a registered sweep lies on the map.
#pragma once

#include "map/local_map.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

struct Closeness {
  double share = 0;  ///< of the points used: those within the gate of a plane, 0 … 1
  double rms_m = 0;  ///< weighted root mean square of their distances
};

/// Of the points of `sweep` that are used, within its own scale: with the same one, sweeps can be compared that were
/// registered with different thresholds.
Closeness closeness(const RegisteredSource& sweep, const LocalMap& map);

}  // namespace rilo
