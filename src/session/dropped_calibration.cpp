#include "session/dropped_calibration.hpp"

#include <cmath>

#include <fmt/format.h>

#include "calibration/same_sensor.hpp"
#include "geometry/degrees.hpp"

namespace rilo {

std::string dropped_calibration(const SensorAngles& known, const SensorAngles& found, double significance) {
  const AngleEstimate& told = known.elevation_estimate;
  const AngleEstimate& seen = found.elevation_estimate;
  if (!std::isfinite(told.sigma_rad) || !(std::abs(seen.rad - told.rad) > significance * told.sigma_rad)) return "";
  return fmt::format(
      "{}: its elevation offset, {:+.3f} ± {:.3f} deg, contradicts this recording, {:+.3f} ± {:.3f} deg, and does not "
      "count: of another unit, or of before a repair?",
      name_of(known), kDegPerRad * told.rad, kDegPerRad * told.sigma_rad, kDegPerRad * seen.rad,
      kDegPerRad * seen.sigma_rad);
}

}  // namespace rilo
