#include <array>
#include <numbers>
#include <utility>

#include "geometry/degrees.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

constexpr std::array<std::pair<SensorKind, std::string_view>, 3> kNames = {{
    {SensorKind::kHdl64, "hdl64"},
    {SensorKind::kVlp16, "vlp16"},
    {SensorKind::kOs1, "os1-64"},
}};

// `count` beams from `top_deg` downwards.
void add_beams(std::vector<double>& elevations, double top_deg, double step_deg, int count) {
  for (int i = 0; i < count; ++i) elevations.push_back((top_deg - step_deg * i) * kRadPerDeg);
}

}  // namespace

std::string_view to_string(SensorKind kind) {
  for (const auto& [value, name] : kNames) {
    if (value == kind) return name;
  }
  return "unknown";
}

std::optional<SensorKind> parse_sensor_kind(std::string_view text) {
  for (const auto& [value, name] : kNames) {
    if (name == text) return value;
  }
  return std::nullopt;
}

double SensorModel::azimuth_rad(double fraction) { return std::numbers::pi * (1.0 - 2.0 * fraction); }

SensorModel sensor_model(SensorKind kind) {
  SensorModel model;
  model.kind = kind;
  model.mount_height_m = 1.73;
  switch (kind) {
    case SensorKind::kHdl64:
      // Upper block 1/3 degree apart, lower block 1/2 degree.
      add_beams(model.elevations_rad, 2.0, 1.0 / 3.0, 32);
      add_beams(model.elevations_rad, -8.83, 0.5, 32);
      model.columns = 2083;
      model.min_range_m = 0.9;
      model.max_range_m = 120;
      break;
    case SensorKind::kVlp16:
      add_beams(model.elevations_rad, 15.0, 2.0, 16);
      model.columns = 1800;
      model.min_range_m = 0.5;
      model.max_range_m = 100;
      break;
    case SensorKind::kOs1:
      add_beams(model.elevations_rad, 22.5, 45.0 / 63.0, 64);
      model.columns = 1024;
      model.min_range_m = 0.5;
      model.max_range_m = 100;
      break;
  }
  return model;
}

}  // namespace rilo
