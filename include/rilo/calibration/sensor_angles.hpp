// What is known about the angles of one LiDAR, to be kept from one recording to the next.
#pragma once

#include <cstdint>
#include <vector>

namespace rilo {

/// Of one beam (rad).
struct BeamCorrection {
  std::uint16_t beam = 0;        ///< its ring; in data without rings a narrow range of elevation angles
  double elevation_rad = 0;      ///< as the sensor gives it
  double add_elevation_rad = 0;  ///< what is added to it
  double add_azimuth_rad = 0;    ///< what is added to the azimuth
};

/// Errors of the angles of one unit, in data that are read in the same way.
struct SensorAngles {
  double elevation_offset_rad = 0;    ///< to be added to all elevation angles
  std::vector<BeamCorrection> beams;  ///< beside it; each beam once
};

}  // namespace rilo
