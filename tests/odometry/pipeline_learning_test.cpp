// What the odometry takes from one sweep to the next: from which on, and what it is taken for.
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/elevation.hpp"
#include "geometry/degrees.hpp"
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

// A recording of one sweep, processed twice.
TEST(PipelineLearning, AfterAResetTheSameSweepBeginsAMapAgain) {
  Odometry odometry({});
  const Sweep sweep = seen(make_box_room({9.3, 7.1, 3.3}, sampling_at(0.0, 0.0, 0)), 0);
  EXPECT_EQ(odometry.register_sweep(sweep).status, OdometryStatus::kInitialising);
  EXPECT_EQ(odometry.register_sweep(sweep).status, OdometryStatus::kEmpty) << "again";
  odometry.reset();
  EXPECT_EQ(odometry.register_sweep(sweep).status, OdometryStatus::kInitialising);
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

// Five sweeps of another place are lost; of the next one a third fits, closely. After a gap the map could end here, but
// no sweep is missing.
TEST(PipelineLearning, SweepsThatWereLostAreNoGap) {
  Odometry odometry({});
  for (std::int64_t i = 0; i < 16; ++i) {
    std::vector<Eigen::Vector3f> points;
    SceneSampling sampling = sampling_at(0.0, 0.0, i);
    sampling.noise_m = 0.015;
    if (i < 10 || i == 15) {
      points = make_box_room({9.3, 7.1, 3.3}, sampling);
    }
    if (i >= 10) {
      const std::vector<Eigen::Vector3f> other = make_box_room({13.0, 11.0, 6.0}, sampling);
      points.insert(points.end(), other.begin(), other.end());
    }
    const SweepResult result = odometry.register_sweep(seen(std::move(points), i));
    EXPECT_EQ(result.status == OdometryStatus::kLost, i >= 10) << i << ' ' << to_string(result.status);
    EXPECT_NE(result.stats.loss_cause, LossCause::kLooseAfterGap) << i;
  }
}

// Pushed aside in dense dust: the sweep is found there, but fits too badly. Its pose is the guess, not what was found.
TEST(PipelineLearning, ALostSweepIsGuessedWhereThePredictionLeads) {
  Odometry odometry({});
  for (std::int64_t i = 0; i < 10; ++i) {
    SceneSampling sampling = sampling_at(0.0, i < 9 ? 0.0 : 0.15, i);
    sampling.noise_m = i < 9 ? 0.005 : 0.08;
    const SweepResult result = odometry.register_sweep(seen(make_box_room({9.3, 7.1, 3.3}, sampling), i));
    if (i == 9) {
      EXPECT_EQ(result.status, OdometryStatus::kLost);
      EXPECT_EQ(result.stats.loss_cause, LossCause::kFitsWorse) << to_string(result.stats.loss_cause);
      EXPECT_GT(result.stats.map_score, 0.6);
      EXPECT_NEAR(result.T_odom_lidar.translation().y(), 0.0, 0.02);
    }
  }
}

// A hall of 24 m by 6 m in which the sensor turns to the side: the way along it is seen least, then across the sensor.
TEST(PipelineLearning, TheEvidenceIsAlongTheAxesOfTheSensor) {
  constexpr std::int64_t kTurned = 32;
  Odometry odometry({});
  for (std::int64_t i = 0; i <= kTurned; ++i) {
    SceneSampling sampling = sampling_at(0.0, 0.0, i);
    sampling.spacing_m = 0.15;
    const double yaw_rad = 0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kTurned);
    sampling.T_world_sensor.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, yaw_rad));
    const SweepResult result = odometry.register_sweep(seen(make_box_room({24.0, 6.1, 3.3}, sampling), i));
    const Eigen::Vector3d evidence = result.translation_evidence.diagonal();
    if (i == 3) {
      EXPECT_LT(evidence.x(), 0.7 * evidence.y());
    } else if (i == kTurned) {
      EXPECT_EQ(result.status, OdometryStatus::kOk);
      EXPECT_LT(evidence.y(), 0.7 * evidence.x());
    }
  }
}

// A sensor whose elevation angles are half a degree too small: once that is known, what is in the map turns, too.
TEST(PipelineLearning, TheMapMovesWithTheElevationOffset) {
  OdometryConfig config;
  config.beams.enabled = false;
  Odometry learning(config);
  config.elevation.enabled = false;
  Odometry fixed(config);
  const ElevationRotation too_low(-0.5 * kRadPerDeg);
  double applied_rad = 0.0;
  for (std::int64_t i = 0; i < 60 && applied_rad == 0.0; ++i) {
    SceneSampling sampling = sampling_at(0.06 * static_cast<double>(i) - 1.8, 0.0, i);
    sampling.T_world_sensor.translation().y() = std::sin(0.2 * static_cast<double>(i));
    std::vector<Eigen::Vector3f> points = make_box_room({9.3, 7.1, 3.3}, sampling);
    for (Eigen::Vector3f& p : points) p = too_low(p);
    const Sweep sweep = seen(std::move(points), i);
    applied_rad = learning.register_sweep(sweep).stats.elevation_applied_rad;
    fixed.register_sweep(sweep);
    EXPECT_EQ(learning.local_map() == fixed.local_map(), applied_rad == 0.0) << i;
  }
  EXPECT_GT(applied_rad, 0.1 * kRadPerDeg);
}

// Where a sweep was found again, a search decided on the pose, not the angles of the sensor.
TEST(PipelineLearning, TheSensorIsNotLearntFromASweepThatWasFoundAgain) {
  Odometry odometry({});
  double known_rad = 0.0;
  for (std::int64_t i = 0; i < 24; ++i) {
    const double x_m = 0.06 * static_cast<double>(i) - 0.7;
    const Eigen::Vector3d size = i == 21 ? Eigen::Vector3d(38.0, 27.0, 15.0) : Eigen::Vector3d(9.3, 7.1, 3.3);
    const SweepResult result = odometry.register_sweep(seen(make_box_room(size, sampling_at(x_m, 0.0, i)), i));
    if (i >= 20) {
      EXPECT_EQ(result.status, i == 21   ? OdometryStatus::kLost
                               : i == 22 ? OdometryStatus::kRecovered
                                         : OdometryStatus::kOk)
          << i << ' ' << to_string(result.status);
      EXPECT_EQ(result.stats.elevation_offset_rad == known_rad, i == 21 || i == 22) << i;
    }
    known_rad = result.stats.elevation_offset_rad;
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
