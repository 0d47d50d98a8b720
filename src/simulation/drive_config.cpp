#include <sstream>
#include <stdexcept>

#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

void require(const char* field, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;  // false for NaN
  std::ostringstream text;
  text << "DriveConfig::" << field << " is " << value << ", expected " << low << " to " << high << unit;
  throw std::invalid_argument(text.str());
}

}  // namespace

void DriveConfig::validate() const {
  require("sensor", static_cast<double>(sensor), 0, 2, " (SensorKind)");
  require("sweeps", static_cast<double>(sweeps), 0, 20000, " (0: one lap)");
  require("start_s", start_s, 0, 2000, " s");
  require("speed_mps", speed_mps, 2, 15, " m/s");
  require("noise_m", noise_m, 0, 0.5, " m");
  require("dropout", dropout, 0, 0.9, "");
  if (max_range_m != 0) {
    require("max_range_m", max_range_m, 5, sensor_model(sensor).max_range_m, " m, or 0 for the sensor's own");
  }
  require("elevation_bias_deg", elevation_bias_deg, -2, 2, " degrees");
  require("moving_cars", static_cast<double>(moving_cars), 0, 12, "");
  require("parked_cars", parked_cars, 0, 1, "");
  require("trees", trees, 0, 1, "");
  require("threads", threads, 0, 1024, " (0: all)");
}

}  // namespace rilo
