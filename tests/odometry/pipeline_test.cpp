// The whole odometry on simulated drives: golden accuracy, ablations, determinism, bad input, loss and recovery.
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

DriveConfig small_drive(double start_s = 4.0, std::size_t sweeps = 25) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = sweeps;
  config.start_s = start_s;
  return config;
}

struct Outcome {
  std::vector<SweepResult> results;
  double worst_error_m = 0;  // of the position, first poses equal
};

Outcome drive(const OdometryConfig& config, const DriveConfig& drive_config) {
  const DriveSimulator simulator(drive_config);
  Odometry odometry(config);
  Outcome run;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const SimulatedSweep s = simulator.sweep(i);
    run.results.push_back(odometry.register_sweep(s.sweep));
    const SE3 error = s.T_odom_lidar_mid.inverse() * run.results.back().T_odom_lidar;
    run.worst_error_m = std::max(run.worst_error_m, error.translation().norm());
  }
  return run;
}

Sweep room_sweep(const SE3& T, std::int64_t stamp_ns, const Eigen::Vector3d& size = {9.3, 7.1, 3.3}) {
  SceneSampling sampling;
  sampling.spacing_m = 0.08;
  sampling.seed = static_cast<std::uint64_t>(stamp_ns) + 1;
  sampling.T_world_sensor = T;
  Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  sweep.points = make_box_room(size, sampling);
  return sweep;
}

SE3 along_x(double x) {
  SE3 T = SE3::Identity();
  T.translation().x() = x;
  return T;
}

TEST(Pipeline, GoldenDriveThatBeginsInMotionStaysWithinCentimetres) {
  const Outcome run = drive({}, small_drive());
  EXPECT_GT(run.results.back().T_odom_lidar.translation().norm(), 10.0);
  EXPECT_LT(run.worst_error_m, 0.12);
  EXPECT_EQ(run.results.front().status, OdometryStatus::kInitialising);
  EXPECT_EQ(run.results.back().status, OdometryStatus::kOk);
  EXPECT_GT(run.results.back().stats.inlier_ratio, 0.3);
}

TEST(Pipeline, AblationsTrackToo) {
  OdometryConfig baseline;
  baseline.coarse.enabled = false;
  baseline.icp.adaptive = false;
  OdometryConfig without_coarse;
  without_coarse.coarse.enabled = false;
  OdometryConfig without_adaptive;
  without_adaptive.icp.adaptive = false;
  OdometryConfig paper;
  paper.coarse.always = true;
  paper.initial_pose.rule = InitialPoseRule::kFixedTau;
  paper.initial_pose.restarts = false;
  paper.prior.enabled = false;
  paper.threshold.forgetting = 1.0;
  for (const OdometryConfig& config : {baseline, without_coarse, without_adaptive, paper}) {
    EXPECT_LT(drive(config, small_drive(0.0, 20)).worst_error_m, 0.15);
  }
}

TEST(Pipeline, SameBitsForAnyNumberOfThreads) {
  OdometryConfig config;
  config.coarse.always = true;
  config.threads = 1;
  const Outcome one = drive(config, small_drive(4.0, 8));
  for (const int threads : {2, 4}) {
    config.threads = threads;
    const Outcome many = drive(config, small_drive(4.0, 8));
    for (std::size_t i = 0; i < one.results.size(); ++i) {
      EXPECT_EQ(one.results[i].T_odom_lidar.matrix(), many.results[i].T_odom_lidar.matrix())
          << threads << " threads, sweep " << i;
    }
  }
}

TEST(Pipeline, ResetStartsAnew) {
  const DriveSimulator simulator(small_drive(2.0, 6));
  Odometry odometry({});
  std::vector<SE3> first;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    first.push_back(odometry.register_sweep(simulator.sweep(i).sweep).T_odom_lidar);
  }
  EXPECT_FALSE(odometry.local_map().empty());
  EXPECT_FALSE(odometry.last_map_points().empty());
  odometry.reset();
  EXPECT_TRUE(odometry.trajectory().empty());
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    EXPECT_EQ(odometry.register_sweep(simulator.sweep(i).sweep).T_odom_lidar.matrix(), first[i].matrix());
  }
}

TEST(Pipeline, ResetForgetsAnotherDrive) {
  Odometry used({});
  for (int i = 0; i < 8; ++i) {  // jerks, at 20 Hz
    used.register_sweep(room_sweep(along_x(0.05 * (i % 2)), 1'000'000'000 + 50'000'000LL * i));
  }
  used.reset();
  Odometry fresh({});
  const DriveSimulator simulator(small_drive(2.0, 4));
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const Sweep sweep = simulator.sweep(i).sweep;
    const SweepResult expected = fresh.register_sweep(sweep);
    const SweepResult result = used.register_sweep(sweep);
    EXPECT_EQ(result.T_odom_lidar.matrix(), expected.T_odom_lidar.matrix()) << i;
    EXPECT_EQ(result.covariance, expected.covariance) << i;
    EXPECT_EQ(result.stamp_ns, expected.stamp_ns) << i;
    EXPECT_EQ(result.stats.sigma_th_m, expected.stats.sigma_th_m) << i;
    EXPECT_EQ(result.stats.gamma, expected.stats.gamma) << i;
  }
}

TEST(Pipeline, BeamsAreLearntFromTheFourthSweepOfAMapOn) {
  DriveConfig config = small_drive(4.0, 5);
  config.sensor = SensorKind::kOs1;
  const Outcome run = drive({}, config);
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    ASSERT_EQ(run.results[i].status, i == 0 ? OdometryStatus::kInitialising : OdometryStatus::kOk);
    EXPECT_EQ(run.results[i].stats.beam_elevation_rms_rad > 0.0, i >= 3) << i;
  }
}

TEST(Pipeline, EmptyAndNanSweepsArePassedOver) {
  Odometry odometry({});
  const SweepResult nothing = odometry.register_sweep({});
  EXPECT_EQ(nothing.status, OdometryStatus::kEmpty);
  EXPECT_GE(nothing.covariance.diagonal().minCoeff(), 1.0);  // rad², m²: that of a guess
  odometry.reset();
  for (int i = 0; i < 12; ++i) {
    Sweep sweep = room_sweep(along_x(0.05 * i), 100'000'000LL * i);
    if (i == 5) {
      for (auto& p : sweep.points) {
        p.setConstant(std::numeric_limits<float>::quiet_NaN());
      }
    }
    const SweepResult result = odometry.register_sweep(sweep);
    EXPECT_EQ(result.status == OdometryStatus::kEmpty, i == 5);
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), 0.05 * i, 0.02) << i;
  }
}

TEST(Pipeline, AGuessedSweepHasTheVelocityOfTheLastAndNoAcceleration) {
  Odometry odometry({});
  SweepResult before;
  for (int i = 0; i < 12; ++i) {
    const double moved_m = 0.01 * i * i;  // 2 m/s²
    before = odometry.register_sweep(room_sweep(along_x(moved_m), 100'000'000LL * i));
    ASSERT_TRUE(i == 0 || before.status == OdometryStatus::kOk) << i << ' ' << to_string(before.status);
  }
  EXPECT_GT(before.acceleration[3], 1.0);
  Sweep nothing;
  nothing.stamp_ns = 1'200'000'000;
  const SweepResult guess = odometry.register_sweep(nothing);
  ASSERT_EQ(guess.status, OdometryStatus::kEmpty);
  EXPECT_EQ(guess.twist, before.twist);
  EXPECT_TRUE(guess.acceleration.isZero(0.0)) << guess.acceleration.transpose();
}

TEST(Pipeline, StampsThatStandStillOrJumpBackDoNotBreakIt) {
  Odometry odometry({});
  const std::int64_t stamps[] = {0, 100, 200, 200, 150, 500, 600};
  for (int i = 0; i < 7; ++i) {
    Sweep sweep = room_sweep(along_x(0.04 * i), stamps[i] * 1'000'000);
    const SweepResult result = odometry.register_sweep(sweep);
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), 0.04 * i, 0.03) << i;
  }
  const Trajectory& trajectory = odometry.trajectory();
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    EXPECT_GT(trajectory[i].stamp_ns, trajectory[i - 1].stamp_ns);
  }
}

TEST(Pipeline, ANewPlaceIsDeclaredLostAndThenMappedAnew) {
  Odometry odometry({});
  std::vector<OdometryStatus> seen;
  for (int i = 0; i < 45; ++i) {
    const Eigen::Vector3d size = i < 15 ? Eigen::Vector3d(9.3, 7.1, 3.3) : Eigen::Vector3d(38.0, 27.0, 15.0);
    seen.push_back(odometry.register_sweep(room_sweep(along_x(0.03 * i), 100'000'000LL * i, size)).status);
  }
  EXPECT_EQ(seen[14], OdometryStatus::kOk);
  EXPECT_NE(std::find(seen.begin() + 15, seen.begin() + 25, OdometryStatus::kLost), seen.begin() + 25);
  EXPECT_NE(std::find(seen.begin() + 15, seen.end(), OdometryStatus::kInitialising), seen.end());
  EXPECT_EQ(seen.back(), OdometryStatus::kOk);
}

TEST(Pipeline, AnEmptySweepAtTheTimeOfTheRestartDoesNotLoseItForGood) {
  OdometryConfig config;
  Odometry odometry(config);
  std::vector<OdometryStatus> seen;
  for (int i = 0; i < 50; ++i) {
    Sweep sweep = room_sweep(along_x(0.03 * i), 100'000'000LL * i);
    if (i >= 10 && i < 10 + config.health.restart_after + 3) {
      sweep.points.clear();
    }
    seen.push_back(odometry.register_sweep(sweep).status);
  }
  EXPECT_NE(std::find(seen.begin() + 23, seen.begin() + 35, OdometryStatus::kRecovered), seen.begin() + 35);
  EXPECT_EQ(seen.back(), OdometryStatus::kOk);
}

TEST(Pipeline, EmptySweepsAtTheBeginningPostponeTheStart) {
  Odometry odometry({});
  for (int i = 0; i < 10; ++i) {
    Sweep sweep = room_sweep(along_x(0.03 * (i - 3)), 100'000'000LL * i);
    if (i < 3) {
      sweep.points.clear();
    }
    const SweepResult result = odometry.register_sweep(sweep);
    EXPECT_EQ(result.status, i < 3    ? OdometryStatus::kEmpty
                             : i == 3 ? OdometryStatus::kInitialising
                                      : OdometryStatus::kOk)
        << i;
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), 0.03 * std::max(i - 3, 0), 0.02) << i;
  }
  EXPECT_EQ(odometry.trajectory().size(), 10U);
}

TEST(Pipeline, AlongASmoothCorridorTheMotionGoesOnAndIsSaidToBeUnseen) {
  // The wall behind goes out of range after 15 m, the one ahead never comes in: then nothing shows the way along.
  constexpr double kStep = 0.3;
  constexpr int kUnseenFrom = 52;
  OdometryConfig config;
  config.preprocess.max_range_m = 30.0;
  Odometry odometry(config);
  int degenerate = 0;
  for (int i = 0; i < 80; ++i) {
    SceneSampling sampling;
    sampling.noise_m = 0.02;
    sampling.seed = static_cast<std::uint64_t>(i) + 1;
    sampling.T_world_sensor = along_x(kStep * i - 45.0);
    Sweep sweep;
    sweep.stamp_ns = 100'000'000LL * i;
    sweep.points = make_box_room({120.0, 5.0, 4.0}, sampling);
    const SweepResult result = odometry.register_sweep(sweep);
    degenerate += i >= kUnseenFrom && result.status == OdometryStatus::kDegenerate ? 1 : 0;
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), i * kStep,
                i < kUnseenFrom ? 0.1 : 0.15 * kStep * (80 - kUnseenFrom))
        << i;
    EXPECT_LT(result.T_odom_lidar.translation().tail<2>().norm(), 0.1) << i;
  }
  EXPECT_GE(degenerate, 25);
}

TEST(Pipeline, AWallOnTheBoundaryOfVoxelsIsSeen) {
  Odometry odometry({});
  for (int i = 0; i < 10; ++i) {
    const SweepResult result =
        odometry.register_sweep(room_sweep(along_x(0.05 * i), 100'000'000LL * i, {24.0, 14.0, 3.0}));
    EXPECT_NEAR(result.T_odom_lidar.translation().x(), 0.05 * i, 0.05) << i;
  }
}

TEST(Pipeline, ImpossibleConfigurationsAreRefused) {
  OdometryConfig config;
  config.map.voxel_m = 0.0;
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
  config = {};
  config.preprocess.max_range_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
}

TEST(Pipeline, ClockGivesStageTimes) {
  std::int64_t ticks = 0;
  Odometry odometry({}, [&ticks] { return ticks += 1'000'000; });
  for (std::int64_t i = 0; i < 2; ++i) {
    const SweepResult result =
        odometry.register_sweep(room_sweep(along_x(0.05 * static_cast<double>(i)), 100'000'000 * i));
    const StageTimes& t = result.stats.times;
    EXPECT_GT(t.preprocess_ms, 0.0) << i;
    EXPECT_GT(t.map_ms, 0.0) << i;
    EXPECT_GE(t.total_ms, t.preprocess_ms + t.initial_pose_ms + t.registration_ms + t.map_ms) << i;
  }
}

}  // namespace
}  // namespace rilo
