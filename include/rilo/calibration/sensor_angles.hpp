// What is known about the angles of one LiDAR, to be kept from one recording to the next.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace rilo {

/// Of one beam (rad).
struct BeamCorrection {
  std::uint16_t beam = 0;        ///< its ring; in data without rings a narrow range of elevation angles
  double elevation_rad = 0;      ///< as the sensor gives it
  double add_elevation_rad = 0;  ///< what is added to it
  double add_azimuth_rad = 0;    ///< what is added to the azimuth
};

/// Estimate of an angle (rad).
struct AngleEstimate {
  double rad = 0;
  double sigma_rad = std::numeric_limits<double>::infinity();  ///< standard deviation; infinite: nothing is known
};

/// Errors of the angles of one unit, in data that are read in the same way.
struct SensorAngles {
  double elevation_offset_rad = 0;    ///< to be added to all elevation angles: the estimate, if that is certain
  AngleEstimate elevation_estimate;   ///< certain or not: counts beside that of other recordings
  std::vector<BeamCorrection> beams;  ///< each beam once
  /// SourceOptions::elevation_correction_deg of the data they were learnt from, which they come on top of; empty:
  /// unknown
  std::optional<double> elevation_correction_deg = {};
  std::vector<std::string> recordings = {};  ///< absolute paths of these data; empty: unknown
  std::string name = {};                     ///< of the file they come from, for messages
};

}  // namespace rilo
