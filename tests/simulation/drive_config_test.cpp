#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

using testing::HasSubstr;

std::string complaint_about(const std::function<void(DriveConfig&)>& change) {
  DriveConfig config;
  change(config);
  try {
    config.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(DriveConfig, DefaultsAreValid) { EXPECT_NO_THROW(DriveConfig().validate()); }

TEST(DriveConfig, NamesTheFieldTheValueAndTheRange) {
  const std::string text = complaint_about([](DriveConfig& c) { c.noise_m = 0.75; });
  EXPECT_THAT(text, HasSubstr("noise_m"));
  EXPECT_THAT(text, HasSubstr("0.75"));
  EXPECT_THAT(text, HasSubstr("0 to 0.5 m"));
}

TEST(DriveConfig, RefusesWhatIsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.sweeps = 20001; }), HasSubstr("sweeps"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.start_s = -0.1; }), HasSubstr("start_s"));
  EXPECT_THAT(complaint_about([=](DriveConfig& c) { c.start_s = infinity; }), HasSubstr("start_s"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.speed_mps = 0; }), HasSubstr("speed_mps"));
  EXPECT_THAT(complaint_about([=](DriveConfig& c) { c.noise_m = nan; }), HasSubstr("noise_m"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.dropout = 1; }), HasSubstr("dropout"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.max_range_m = 4; }), HasSubstr("max_range_m"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.max_range_m = 121; }), HasSubstr("5 to 120 m"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.elevation_bias_deg = 3; }), HasSubstr("elevation_bias_deg"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.moving_cars = 13; }), HasSubstr("moving_cars"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.parked_cars = 1.1; }), HasSubstr("parked_cars"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.trees = -1; }), HasSubstr("trees"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.threads = -1; }), HasSubstr("threads"));
  EXPECT_THAT(complaint_about([](DriveConfig& c) { c.sensor = static_cast<SensorKind>(7); }), HasSubstr("sensor"));
}

TEST(SensorModel, NamesGoBothWays) {
  for (const SensorKind kind : {SensorKind::kHdl64, SensorKind::kVlp16, SensorKind::kOs1}) {
    EXPECT_EQ(parse_sensor_kind(to_string(kind)), kind);
    EXPECT_EQ(sensor_model(kind).kind, kind);
  }
  EXPECT_EQ(parse_sensor_kind("HDL64"), std::nullopt);
  EXPECT_EQ(parse_sensor_kind(""), std::nullopt);
}

TEST(SensorModel, HasTheBeamsOfTheDataSheets) {
  const auto expect_beams = [](SensorKind kind, std::size_t beams, double top_deg, double bottom_deg) {
    const SensorModel model = sensor_model(kind);
    ASSERT_EQ(model.beams(), beams);
    const double deg = 180 / std::numbers::pi;
    EXPECT_NEAR(model.elevations_rad.front() * deg, top_deg, 1e-9);
    EXPECT_NEAR(model.elevations_rad.back() * deg, bottom_deg, 1e-9);
    for (std::size_t i = 1; i < beams; ++i) EXPECT_LT(model.elevations_rad[i], model.elevations_rad[i - 1]);
  };
  expect_beams(SensorKind::kHdl64, 64, 2.0, -24.33);
  expect_beams(SensorKind::kVlp16, 16, 15.0, -15.0);
  expect_beams(SensorKind::kOs1, 64, 22.5, -22.5);
}

TEST(SensorModel, TurnsClockwiseFromBehind) {
  EXPECT_DOUBLE_EQ(SensorModel::azimuth_rad(0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(SensorModel::azimuth_rad(0.25), std::numbers::pi / 2);  // left
  EXPECT_DOUBLE_EQ(SensorModel::azimuth_rad(0.5), 0);                      // ahead
  EXPECT_DOUBLE_EQ(SensorModel::azimuth_rad(0.75), -std::numbers::pi / 2);
}

}  // namespace
}  // namespace rilo
