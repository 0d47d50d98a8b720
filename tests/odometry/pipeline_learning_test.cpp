// What the odometry takes from one sweep to the next: from which on, and what it is taken for.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

Sweep seen(std::vector<Eigen::Vector3f> points, std::int64_t index) {
  Sweep sweep;
  sweep.stamp_ns = 100'000'000 * index;
  sweep.points = std::move(points);
  return sweep;
}

SceneSampling sampling_at(double x_m, double y_m, std::int64_t index) {
  SceneSampling sampling;
  sampling.spacing_m = 0.08;
  sampling.seed = static_cast<std::uint64_t>(index) + 1;
  sampling.T_world_sensor.translation() << x_m, y_m, 0.0;
  return sampling;
}

// Its second sweep starts without a velocity: how far that is off says nothing of later ones.
TEST(PipelineLearning, TheThresholdLearnsFromTheThirdSweepOn) {
  Odometry odometry({});
  for (std::int64_t i = 0; i < 4; ++i) {
    const SweepStats stats =
        odometry
            .register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(0.05 * static_cast<double>(i), 0.0, i)), i))
            .stats;
    if (i < 3) {
      EXPECT_EQ(stats.sigma_th_m, i == 0 ? 0.0 : AdaptiveThresholdConfig{}.initial_m) << i;
    } else {
      EXPECT_LT(stats.sigma_th_m, 0.1);
    }
  }
}

// Steps grow by 10 cm from sweep to sweep: that goes on, and the motion counts as steady.
TEST(PipelineLearning, ASteadyAccelerationDoesNotWeighLess) {
  Odometry odometry({});
  double x_m = -2.0;
  for (std::int64_t i = 0; i < 7; ++i) {
    const SweepResult result =
        odometry.register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(x_m, 0.0, i)), i));
    x_m += 0.1 * static_cast<double>(i + 1);
    if (i >= 4) {
      EXPECT_EQ(result.status, OdometryStatus::kOk) << i;
      EXPECT_GT(result.stats.gamma, 0.98) << i;
    }
  }
}

// Two sweeps are missing: the step is three times as long, which counts as jerk, so that what a gap leaves of error
// hardly widens the threshold.
TEST(PipelineLearning, AGapWeighsLess) {
  Odometry odometry({});
  for (const std::int64_t i : {0, 1, 2, 3, 4, 7, 8, 9}) {
    const SweepResult result = odometry.register_sweep(
        seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(0.3 * static_cast<double>(i) - 1.5, 0.0, i)), i));
    if (i == 4) {
      EXPECT_GT(result.stats.gamma, 0.98);
    } else if (i == 7) {
      EXPECT_NEAR(result.stats.gamma, std::exp(-2 * 0.3 / AdaptiveThresholdConfig{}.decay), 0.02);
    } else if (i > 7) {
      EXPECT_LT(result.stats.gamma, 0.75) << i;
    }
    EXPECT_EQ(result.status, i == 0 ? OdometryStatus::kInitialising : OdometryStatus::kOk) << i;
  }
}

// Along the corridor nothing is seen, so that it is not vouched for; across it is where it was found.
TEST(PipelineLearning, AMapThatBeginsWithALostSecondSweepBeginsWhereThatWasFound) {
  Odometry odometry({});
  odometry.register_sweep(seen(make_corridor(60.0, 4.0, 3.0, sampling_at(0.0, 0.0, 0)), 0));
  const SweepResult second = odometry.register_sweep(seen(make_corridor(60.0, 4.0, 3.0, sampling_at(0.0, 0.25, 1)), 1));
  EXPECT_EQ(second.status, OdometryStatus::kInitialising);
  EXPECT_NEAR(second.T_odom_lidar.translation().y(), 0.25, 0.02);
}

// A metre and a half in the first step and nothing in the next: one of the two did not take its time.
TEST(PipelineLearning, AMapThatBeginsWithAClaimBeginsThere) {
  Odometry odometry({});
  SweepResult result;
  for (std::int64_t i = 0; i < 3; ++i) {
    const double y_m = i < 1 ? 0.0 : 1.5;
    result = odometry.register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(0.0, y_m, i)), i));
  }
  EXPECT_EQ(result.status, OdometryStatus::kInitialising);
  EXPECT_NEAR(result.T_odom_lidar.translation().y(), 1.5, 0.02);
}

// Pushed aside: no sensor moves so, but the sweep fits as those before, and it goes on from there.
TEST(PipelineLearning, WhatFitsAsUsualIsTakenWhereverItLies) {
  Odometry odometry({});
  for (std::int64_t i = 0; i < 10; ++i) {
    const double y_m = i < 8 ? 0.0 : 0.7;
    const SweepResult result =
        odometry.register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(0.0, y_m, i)), i));
    EXPECT_EQ(result.stats.impossible_motion, i == 8);
    if (i >= 8) {
      EXPECT_EQ(result.status, OdometryStatus::kOk);
      EXPECT_EQ(result.stats.prediction_score > 0.9, i == 9) << "two of six walls are elsewhere at first";
      EXPECT_NEAR(result.T_odom_lidar.translation().y(), 0.7, 0.02);
    }
  }
}

// Pushed aside, and the ranges scatter more than before: no sensor moves so, and the sweep is lost; the next one is
// expected where it lay, not where it should.
TEST(PipelineLearning, AfterAClaimTheNextSweepIsExpectedThere) {
  Odometry odometry({});
  for (std::int64_t i = 0; i < 10; ++i) {
    SceneSampling sampling = sampling_at(0.0, i < 8 ? 0.0 : 0.7, i);
    sampling.noise_m = i < 8 ? 0.01 : 0.025;
    const SweepResult result = odometry.register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling), i));
    if (i == 8) {
      EXPECT_EQ(result.status, OdometryStatus::kLost);
      EXPECT_LT(result.stats.prediction_score, 0.8) << "two of six walls are elsewhere";
    } else if (i == 9) {
      EXPECT_EQ(result.status, OdometryStatus::kRecovered);
      EXPECT_GT(result.stats.prediction_score, 0.9);
      EXPECT_NEAR(result.T_odom_lidar.translation().y(), 0.7, 0.02);
    }
  }
}

// Of a drive at 6 m/s: the first sweep had that velocity, too.
TEST(PipelineLearning, ADriveThatBeginsInMotionDoesNotBeginWithAnAcceleration) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = 2;
  config.start_s = 4.0;
  const DriveSimulator simulator(config);
  Odometry odometry({});
  odometry.register_sweep(simulator.sweep(0).sweep);
  const SweepResult second = odometry.register_sweep(simulator.sweep(1).sweep);
  ASSERT_EQ(second.status, OdometryStatus::kOk);
  EXPECT_GT(second.twist[3], 5.0);
  EXPECT_LT(std::sqrt(second.covariance(3, 3)), 0.01) << "60 m/s² would be 1 cm more";
}

}  // namespace
}  // namespace rilo
