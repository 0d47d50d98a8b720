// The spinning sensors that can be simulated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace rilo {

enum class SensorKind : std::uint8_t { kHdl64, kVlp16, kOs1 };

/// hdl64, vlp16, os1-64.
std::string_view to_string(SensorKind kind);
std::optional<SensorKind> parse_sensor_kind(std::string_view text);

/// Geometry of a sensor that spins clockwise (seen from above) once per sweep, from straight behind to straight behind,
/// so that the middle of the sweep looks ahead. All beams of a column fire together.
struct SensorModel {
  SensorKind kind = SensorKind::kHdl64;
  std::vector<double> elevations_rad;  ///< one per beam (ring), topmost first
  std::size_t columns = 0;             ///< firings per sweep
  double period_s = 0.1;               ///< one sweep
  double min_range_m = 0;
  double max_range_m = 0;
  double mount_height_m = 0;  ///< above the ground, as it is mounted on the simulated vehicle

  std::size_t beams() const { return elevations_rad.size(); }
  /// Azimuth (rad, counter-clockwise from straight ahead) of the firing at `fraction` (0 … 1) of the sweep.
  static double azimuth_rad(double fraction);
};

SensorModel sensor_model(SensorKind kind);

}  // namespace rilo
