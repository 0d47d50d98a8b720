// A budget that holds: the rule by itself, and the odometry on a clock that the test turns.
#include "odometry/time_budget.hpp"

#include <algorithm>
#include <atomic>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

constexpr int kSourcePoints = 20000;
constexpr std::size_t kRawPoints = 100000;

TEST(UsualTime, MeanWithTwiceTheDeviation) {
  UsualTime time;
  EXPECT_FALSE(time.known());
  time.learn(10.0);
  EXPECT_DOUBLE_EQ(time.upper(), 20.0) << "one value shows no deviation: half of it";
  for (int i = 0; i < 50; ++i) {
    time.learn(10.0);
  }
  EXPECT_NEAR(time.upper(), 10.0, 0.01);
  time.learn(1000.0);
  EXPECT_LE(time.mean(), 12.01) << "an accident is no trend";
}

TEST(TimeBudget, WithoutOneNothingIsCut) {
  TimeBudget budget({0.0}, kSourcePoints);
  budget.learn(Work::kPrepare, 1.0, 1e6);
  EXPECT_FALSE(budget.limited());
  EXPECT_FALSE(budget.affordable(kRawPoints, true, true).cut());
  EXPECT_EQ(budget.share_in_time(1e9, 1.0), 1.0);
}

/// A budget that knows usual sweeps well.
TimeBudget experienced(double budget_ms, double prepare_ms, double rest_ms) {
  TimeBudget budget({budget_ms}, kSourcePoints);
  for (int i = 0; i < 100; ++i) {
    budget.learn(Work::kPrepare, kRawPoints, prepare_ms);
    budget.learn(Work::kRest, 1.0, rest_ms);
  }
  return budget;
}

TEST(TimeBudget, ASearchThatRanOutOfTimeGetsFewerPointsNextTime) {
  TimeBudget budget = experienced(20.0, 5.0, 20.0);
  const auto share = [&] { return budget.affordable(kRawPoints, false, true).source; };
  const double first = share();
  budget.learn_doubt(true);
  EXPECT_NEAR(share(), 0.5 * first, 1e-9);
  for (int i = 0; i < 10; ++i) budget.learn_doubt(true);
  EXPECT_EQ(share(), TimeBudget::kLeastShare);
  for (int i = 0; i < 10; ++i) budget.learn_doubt(false);
  EXPECT_EQ(share(), first);
}

TEST(TimeBudget, SourcePointsAreCutToFit) {
  EXPECT_FALSE(experienced(50.0, 5.0, 20.0).affordable(kRawPoints, false, false).cut());
  const TimeBudget budget = experienced(20.0, 5.0, 20.0);
  const PointShares shares = budget.affordable(kRawPoints, false, false);
  EXPECT_EQ(shares.raw, 1.0) << "preparing takes less than its part";
  EXPECT_NEAR(shares.source * 20.0, budget.target_ms() - 5.0, 0.01);
  EXPECT_LT(budget.affordable(kRawPoints, false, true).source, 0.5 * shares.source) << "time to search";
}

TEST(TimeBudget, RawPointsAreCutWherePreparingWouldTakeTooLong) {
  const TimeBudget budget = experienced(20.0, 15.0, 5.0);
  const PointShares shares = budget.affordable(kRawPoints, false, false);
  EXPECT_NEAR(shares.raw * 15.0, 0.3 * budget.target_ms(), 0.01);
  EXPECT_EQ(budget.affordable(kRawPoints / 10, false, false).raw, 1.0) << "a small sweep is not thinned";
  EXPECT_LT(budget.affordable(kRawPoints, true, false).raw, shares.raw) << "prepared several times";
}

TEST(TimeBudget, TheFirstSweepIsTakenToBeSlow) {
  const TimeBudget budget({20.0}, kSourcePoints);
  EXPECT_LT(budget.affordable(kRawPoints, true, true).raw, 0.5);
  EXPECT_FALSE(TimeBudget({10000.0}, kSourcePoints).affordable(kRawPoints, true, true).cut());
}

TEST(TimeBudget, AnImpossibleOneLeavesTheLeastShare) {
  const PointShares shares = experienced(1.0, 5.0, 20.0).affordable(kRawPoints, false, false);
  EXPECT_EQ(shares.raw, TimeBudget::kLeastShare);
  EXPECT_EQ(shares.source, TimeBudget::kLeastShare);
  EXPECT_EQ(experienced(1.0, 5.0, 20.0).share_in_time(5.0, -3.0), TimeBudget::kLeastShare);
}

TEST(TimeBudget, ResetForgets) {
  TimeBudget budget = experienced(20.0, 5.0, 20.0);
  const double known = budget.ms(Work::kRest);
  budget.reset();
  EXPECT_GT(budget.ms(Work::kRest), known);
}

/// A clock that moves on by a tick whenever it is read: time is what is asked about it.
class TickingClock {
 public:
  explicit TickingClock(double tick_ms) : tick_ns_(static_cast<std::int64_t>(tick_ms * 1e6)) {}
  Odometry::Clock reader() {
    return [this] { return now_ns_ += tick_ns_; };
  }

 private:
  std::int64_t tick_ns_;
  std::atomic<std::int64_t> now_ns_ = 0;
};

DriveSimulator short_drive() {
  DriveConfig drive;
  drive.sensor = SensorKind::kVlp16;
  drive.sweeps = 12;
  drive.start_s = 4.0;
  return DriveSimulator(drive);
}

struct Setting {
  double tick_ms = 0.1;
  double budget_ms = 0.0;
  int threads = 1;
  bool coarse_always = false;
  std::size_t jump_after = 1000;  // then half of the sweeps are missing
};

std::vector<SweepResult> run(const Setting& setting) {
  static const DriveSimulator kDrive = short_drive();
  OdometryConfig config;
  config.budget.sweep_ms = setting.budget_ms;
  config.coarse.always = setting.coarse_always;
  config.threads = setting.threads;
  TickingClock clock(setting.tick_ms);
  Odometry odometry(config, clock.reader());
  std::vector<SweepResult> results;
  std::int64_t stamp_ns = 0;
  for (std::size_t i = 0; i < kDrive.size(); ++i) {
    if (i > setting.jump_after && i < setting.jump_after + kDrive.size() / 2) {
      continue;
    }
    Sweep sweep = kDrive.sweep(i).sweep;
    sweep.stamp_ns = stamp_ns += 100'000'000;  // no gap shows
    results.push_back(odometry.register_sweep(sweep));
  }
  return results;
}

double longest_ms(const std::vector<SweepResult>& results) {
  double longest = 0.0;
  for (const SweepResult& result : results) {
    longest = std::max(longest, result.stats.times.total_ms);
  }
  return longest;
}

std::size_t count(const std::vector<SweepResult>& results, bool SweepStats::*flag) {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [&](const SweepResult& r) { return r.stats.*flag; }));
}

std::size_t cuts(const std::vector<SweepResult>& results) {
  return count(results, &SweepStats::points_cut) + count(results, &SweepStats::coarse_cut) +
         count(results, &SweepStats::over_budget);
}

double step_m(const std::vector<SweepResult>& results, std::size_t i) {
  return (results[i - 1].T_odom_lidar.inverse() * results[i].T_odom_lidar).translation().norm();
}

TEST(TimeBudgetPipeline, WithTimeToSpareTheBitsAreThoseWithoutABudget) {
  const auto free = run({.tick_ms = 1e-3});
  for (const int threads : {1, 2}) {
    const auto ample = run({.tick_ms = 1e-3, .budget_ms = 1e5, .threads = threads});
    EXPECT_EQ(cuts(ample), 0U);
    ASSERT_EQ(ample.size(), free.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
      EXPECT_EQ(ample[i].T_odom_lidar.matrix(), free[i].T_odom_lidar.matrix()) << i;
      EXPECT_EQ(ample[i].covariance, free[i].covariance) << i;
    }
  }
}

TEST(TimeBudgetPipeline, TheSecondSweepEndsInTime) {
  constexpr double kBudgetMs = 70.0;
  const auto ample = run({.tick_ms = 1.0, .budget_ms = 1e6});
  ASSERT_GT(ample[1].stats.times.total_ms, 1.5 * kBudgetMs) << "or there is nothing to cut";
  for (const int threads : {1, 2}) {
    const auto hurried = run({.tick_ms = 1.0, .budget_ms = kBudgetMs, .threads = threads});
    EXPECT_LE(longest_ms(hurried), kBudgetMs);
    EXPECT_TRUE(hurried[1].stats.points_cut || hurried[1].stats.coarse_cut);
    EXPECT_EQ(count(hurried, &SweepStats::over_budget), 0U);
    EXPECT_NEAR(step_m(hurried, hurried.size() - 1), step_m(ample, ample.size() - 1), 0.05);
  }
}

TEST(TimeBudgetPipeline, TheRestartsAfterAJumpEndInTime) {
  constexpr std::size_t kBefore = 5;
  constexpr double kBudgetMs = 100.0;
  const auto ample = run({.tick_ms = 1.0, .budget_ms = 1e6, .jump_after = kBefore});
  ASSERT_GT(ample[kBefore + 1].stats.times.total_ms, 1.5 * kBudgetMs) << "or there is nothing to cut";
  const auto hurried = run({.tick_ms = 1.0, .budget_ms = kBudgetMs, .jump_after = kBefore});
  EXPECT_LE(longest_ms(hurried), kBudgetMs);
  EXPECT_TRUE(hurried[kBefore + 1].stats.coarse_cut);
}

TEST(TimeBudgetPipeline, ARawSweepTooLargeIsThinned) {
  // One tick is what preparing takes: more than its part of the budget.
  const auto hurried = run({.tick_ms = 20.0, .budget_ms = 60.0});
  const SweepStats& stats = hurried.back().stats;
  EXPECT_TRUE(stats.points_cut);
  EXPECT_LT(stats.points_valid, 9 * stats.points_in / 10);
  const SweepStats whole = run({.tick_ms = 0.1}).back().stats;
  EXPECT_GT(whole.points_valid, 9 * whole.points_in / 10);
}

TEST(TimeBudgetPipeline, AnImpossibleBudgetGivesAPoseAndSaysSo) {
  const auto ample = run({.tick_ms = 1.0, .budget_ms = 1e6, .coarse_always = true});
  const auto hurried = run({.tick_ms = 1.0, .budget_ms = 1.0, .coarse_always = true});
  ASSERT_GT(longest_ms(ample), 100.0) << "or there is nothing to cut";
  EXPECT_LE(longest_ms(hurried), 14.0) << "the least that gives a pose, in ticks of 1 ms";
  EXPECT_EQ(count(hurried, &SweepStats::over_budget), hurried.size());
  EXPECT_EQ(count(hurried, &SweepStats::points_cut), hurried.size());
  EXPECT_EQ(count(hurried, &SweepStats::coarse_cut), hurried.size() - 1) << "all but the first";
  for (std::size_t i = 1; i < hurried.size(); ++i) {
    EXPECT_TRUE(hurried[i].T_odom_lidar.matrix().allFinite());
    EXPECT_FALSE(hurried[i].stats.converged);
  }
}

TEST(TimeBudgetPipeline, ResetForgetsWhatWorkCosts) {
  const DriveSimulator drive = short_drive();
  OdometryConfig config;
  config.budget.sweep_ms = 80.0;
  config.threads = 1;
  TickingClock clock(1.0);
  Odometry odometry(config, clock.reader());
  std::vector<SweepResult> first;
  for (std::size_t i = 0; i < 5; ++i) {
    first.push_back(odometry.register_sweep(drive.sweep(i).sweep));
  }
  EXPECT_GT(count(first, &SweepStats::points_cut), 0U) << "or nothing depends on it";
  odometry.reset();
  for (std::size_t i = 0; i < first.size(); ++i) {
    const SweepResult again = odometry.register_sweep(drive.sweep(i).sweep);
    EXPECT_EQ(again.stats.points_source, first[i].stats.points_source) << i;
    EXPECT_EQ(again.T_odom_lidar.matrix(), first[i].T_odom_lidar.matrix()) << i;
  }
}

TEST(TimeBudgetPipeline, ABudgetNeedsAClock) {
  OdometryConfig config;
  config.budget.sweep_ms = 50.0;
  EXPECT_THROW(Odometry{config}, std::invalid_argument);
}

}  // namespace
}  // namespace rilo
