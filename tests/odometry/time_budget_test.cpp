// Less work when time is short: the rule by itself, and the odometry on a clock that the test turns.
#include "odometry/time_budget.hpp"

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

TEST(TimeBudget, WithoutOneNothingIsCut) {
  TimeBudget budget({0.0});
  budget.learn(1e6, 1e5, 3);
  EXPECT_FALSE(budget.limited());
  EXPECT_EQ(budget.point_share(), 1.0);
  EXPECT_TRUE(budget.coarse_fits(1e9));
}

TEST(TimeBudget, PointsFollowTheTimeAndComeBack) {
  TimeBudget budget({50.0});
  budget.learn(60.0, 0.0, 0);  // the target is 40 ms
  EXPECT_NEAR(budget.point_share(), 40.0 / 60.0, 1e-12);
  budget.learn(400.0, 0.0, 0);
  EXPECT_NEAR(budget.point_share(), 20.0 / 60.0, 1e-12) << "halved at most";
  for (int i = 0; i < 10; ++i) {
    budget.learn(400.0, 0.0, 0);
  }
  EXPECT_EQ(budget.point_share(), TimeBudget::kLeastShare);
  budget.learn(38.0, 0.0, 0);
  EXPECT_EQ(budget.point_share(), TimeBudget::kLeastShare) << "in time, but with nothing to spare";
  for (int i = 0; i < 100; ++i) {
    budget.learn(20.0, 0.0, 0);
  }
  EXPECT_EQ(budget.point_share(), 1.0);
  budget.learn(60.0, 0.0, 0);
  budget.reset();
  EXPECT_EQ(budget.point_share(), 1.0);
}

TEST(TimeBudget, TheCoarseStageMustFitIntoWhatIsLeft) {
  TimeBudget budget({50.0});
  EXPECT_TRUE(budget.coarse_fits(5.0)) << "nothing is known yet";
  budget.learn(20.0 + 60.0, 60.0, 3);  // 20 ms a start, 20 ms the rest: not the points' fault
  EXPECT_EQ(budget.point_share(), 1.0);
  EXPECT_TRUE(budget.coarse_fits(20.0));
  EXPECT_FALSE(budget.coarse_fits(20.1));
}

struct Hurry {
  std::size_t points = 0;  // of the last sweep
  std::size_t points_cut = 0;
  std::size_t coarse_cut = 0;
  std::size_t over = 0;
  std::size_t no_time = 0;
  double error_m = 0;
};

/// A drive on a clock that moves on by `tick_ms` whenever it is read.
Hurry run_on_clock(double tick_ms, double budget_ms, bool coarse_always) {
  DriveConfig drive;
  drive.sensor = SensorKind::kVlp16;
  drive.sweeps = 12;
  drive.start_s = 4.0;
  const DriveSimulator simulator(drive);
  OdometryConfig config;
  config.budget.sweep_ms = budget_ms;
  config.coarse.always = coarse_always;
  std::int64_t time_ns = 0;
  Odometry odometry(config, [&] { return time_ns += static_cast<std::int64_t>(tick_ms * 1e6); });
  Hurry run;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    const SimulatedSweep s = simulator.sweep(i);
    const SweepResult result = odometry.register_sweep(s.sweep);
    run.points = result.stats.points_source;
    run.points_cut += result.stats.points_cut ? 1 : 0;
    run.coarse_cut += result.stats.coarse_cut ? 1 : 0;
    run.over += result.stats.over_budget ? 1 : 0;
    run.no_time += result.stats.initial_pose_reason == InitialPoseReason::kNoTime ? 1 : 0;
    run.error_m = (s.T_odom_lidar_mid.inverse() * result.T_odom_lidar).translation().norm();
  }
  return run;
}

TEST(TimeBudgetPipeline, EnoughTimeCutsNothing) {
  const Hurry run = run_on_clock(0.1, 1000.0, true);
  EXPECT_EQ(run.points_cut + run.coarse_cut + run.over + run.no_time, 0U);
}

TEST(TimeBudgetPipeline, TooLittleTimeCutsPointsAndTheCoarseStageAndSaysSo) {
  const Hurry all = run_on_clock(0.1, 0.0, true);
  const Hurry hurried = run_on_clock(20.0, 60.0, true);
  EXPECT_GT(hurried.points_cut, 8U);
  EXPECT_LT(hurried.points, all.points / 2);
  EXPECT_GT(hurried.coarse_cut, 6U);
  EXPECT_GT(hurried.no_time, 6U);
  EXPECT_GT(hurried.over, 8U);
  EXPECT_LT(hurried.error_m, 0.5) << "worse, not lost";
}

TEST(TimeBudgetPipeline, ABudgetNeedsAClock) {
  OdometryConfig config;
  config.budget.sweep_ms = 50.0;
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
}

}  // namespace
}  // namespace rilo
