// What a new map takes over from the one before, and what not.
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

SceneSampling sampled(std::int64_t index) {
  SceneSampling sampling;
  sampling.spacing_m = 0.08;
  sampling.seed = static_cast<std::uint64_t>(index) + 1;
  return sampling;
}

SweepResult taken(Odometry& odometry, std::vector<Eigen::Vector3f> points, std::int64_t index) {
  Sweep sweep;
  sweep.stamp_ns = 100'000'000 * index;
  sweep.points = std::move(points);
  return odometry.register_sweep(sweep);
}

std::vector<Eigen::Vector3f> hall(std::int64_t index) {
  SceneSampling sampling = sampled(index);
  sampling.spacing_m = 0.15;
  return make_box_room({20.3, 15.1, 8.3}, sampling);
}

/// Over the sensor, wherever that is.
std::vector<Eigen::Vector3f> cover(std::int64_t index) {
  SceneSampling sampling = sampled(index);
  sampling.spacing_m = 0.03;
  return make_box_room({2.7, 2.3, 1.7}, sampling);
}

// All sweeps fitted the map before closely, so that its gate was narrow; of a new map nothing is known.
TEST(MapBeginning, TheGateIsTheFirstOneAgain) {
  const OdometryConfig config;
  Odometry odometry(config);
  std::int64_t i = 0;
  for (; i < 10; ++i) {
    taken(odometry, make_box_room({9.3, 7.1, 3.3}, sampled(i)), i);
  }
  OdometryStatus status = OdometryStatus::kOk;
  for (; status != OdometryStatus::kInitialising && i < 40; ++i) {
    const SweepResult result = taken(odometry, make_box_room({38.0, 27.0, 15.0}, sampled(i)), i);
    status = result.status;
    EXPECT_LT(result.stats.sigma_th_m, config.threshold.initial_m) << i;
  }
  ASSERT_EQ(status, OdometryStatus::kInitialising);
  const SweepResult second = taken(odometry, make_box_room({38.0, 27.0, 15.0}, sampled(i)), i);
  EXPECT_EQ(second.status, OdometryStatus::kOk);
  EXPECT_EQ(second.stats.sigma_th_m, config.threshold.initial_m);
}

// A box over the sensor for longer than a map is kept: it moves along, so that no pose in a map of it is vouched for.
TEST(MapBeginning, AMapOfWhatCoversTheSensorShowsNoMotion) {
  Odometry odometry({});
  std::size_t begun = 0;
  for (std::int64_t i = 0; i < 30; ++i) {
    const bool covered = i >= 10;
    const SweepResult result = covered ? taken(odometry, cover(i), i) : taken(odometry, hall(i), i);
    if (covered) {
      begun += result.status == OdometryStatus::kInitialising ? 1 : 0;
      EXPECT_TRUE(result.status == OdometryStatus::kInitialising || result.status == OdometryStatus::kLost)
          << i << ' ' << to_string(result.status);
      EXPECT_EQ(result.stats.loss_cause, LossCause::kCovered) << i;
    }
  }
  EXPECT_GT(begun, 0U);
}

// Put away under a cover, the odometry reset: the next drive begins in a small place, at rest.
TEST(MapBeginning, AfterAResetNothingCoversTheSensor) {
  Odometry odometry({});
  OdometryStatus status = OdometryStatus::kOk;
  std::int64_t i = 0;
  for (; status != OdometryStatus::kInitialising && i < 40; ++i) {
    const SweepResult result = i >= 10 ? taken(odometry, cover(i), i) : taken(odometry, hall(i), i);
    status = i == 0 ? OdometryStatus::kOk : result.status;
  }
  ASSERT_GT(i, 12);
  odometry.reset();
  for (; i < 100; i += 50) {
    status = taken(odometry, make_box_room({4.1, 3.5, 2.6}, sampled(i)), i).status;
  }
  EXPECT_EQ(status, OdometryStatus::kOk);
}

}  // namespace
}  // namespace rilo
