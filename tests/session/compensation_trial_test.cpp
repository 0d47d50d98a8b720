// Raw or compensated: points without times, told apart by how they fit.
#include "session/compensation_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/degrees.hpp"
#include "io/sweeps_source.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/session/session.hpp"
#include "rilo/session/session_observer.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::test {
namespace {

constexpr std::size_t kTrialSweeps = 30;
// So many of them are compared at least: not those that begin a map, or are lost.
constexpr std::size_t kLeastCompared = 24;
constexpr double kPeriodS = 0.1;

struct Drive {
  std::vector<Sweep> sweeps;
  std::vector<SE3> truth;  // at mid-sweep
};

/// Column by column, as drivers write it, and without times.
Drive drive(bool deskewed, std::size_t sweeps = kTrialSweeps) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = sweeps;
  config.start_s = 10.0;
  config.deskewed = deskewed;
  const DriveSimulator simulator(config);
  Drive drive;
  for (std::size_t i = 0; i < sweeps; ++i) {
    SimulatedSweep simulated = simulator.sweep(i);
    drive.sweeps.push_back(std::move(simulated.sweep));
    drive.sweeps.back().times_s.clear();
    drive.truth.push_back(simulated.T_odom_lidar_mid);
  }
  return drive;
}

const Drive& raw() {
  static const Drive kDrive = drive(false);
  return kDrive;
}
const Drive& compensated() {
  static const Drive kDrive = drive(true);
  return kDrive;
}

CompensationTrial trial_of(const std::vector<Sweep>& sweeps, const OdometryConfig& config = {},
                           const std::function<bool()>& interrupted = {}) {
  return try_compensation([&] { return std::make_unique<SweepsSource>(sweeps); }, 0, config, interrupted);
}

SessionResult run_of(const std::vector<Sweep>& sweeps, PointTimes point_times, bool one_pass = false) {
  SessionOptions options;
  options.point_times = point_times;
  options.one_pass = one_pass;
  return Session([&] { return std::make_unique<SweepsSource>(sweeps); }, options).run();
}

std::vector<Eigen::Matrix4d> poses_of(const SessionResult& run) {
  std::vector<Eigen::Matrix4d> matrices;
  for (const StampedPose& pose : run.trajectory()) matrices.emplace_back(pose.T_odom_lidar.matrix());
  return matrices;
}

double error_at_end_m(const SessionResult& run, const Drive& drive) {
  const SE3 truth = drive.truth.front().inverse() * drive.truth.back();
  const SE3 found = run.results.front().T_odom_lidar.inverse() * run.results.back().T_odom_lidar;
  return (truth.inverse() * found).translation().norm();
}

TEST(CompensationTrial, RawPointsFitBetter) {
  const CompensationTrial trial = trial_of(raw().sweeps);
  EXPECT_GE(trial.sweeps, kLeastCompared);
  EXPECT_GE(10 * trial.better, 9 * trial.sweeps);
  EXPECT_TRUE(trial.raw());
}

/// Of every so many sweeps of a drive, which are so far apart.
std::string times_found(std::size_t every, double period_s) {
  static const std::vector<Sweep> kAll = drive(false, 48).sweeps;
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < kAll.size(); i += every) {
    sweeps.push_back(kAll[i]);
    sweeps.back().stamp_ns = std::llround(static_cast<double>(sweeps.size()) * period_s * 1e9);
  }
  SessionOptions options;
  options.point_times = PointTimes::kAuto;
  const SessionResult run = Session([&] { return std::make_unique<SweepsSource>(sweeps, period_s); }, options).run();
  EXPECT_TRUE(run.trial.raw());
  return run.source.point_times;
}

TEST(CompensationTrial, ATurnIsNotLongerWhereSweepsWereLeftOut) {
  EXPECT_EQ(times_found(3, 0.3), "order of the points, period 0.100000 s");
  EXPECT_EQ(times_found(2, 0.2), "order of the points, period 0.100000 s");
  EXPECT_EQ(times_found(1, 0.2), "order of the points, period 0.200000 s") << "a sensor at 5 Hz";
}

TEST(CompensationTrial, CompensatedOnesDoNot) {
  const CompensationTrial trial = trial_of(compensated().sweeps);
  EXPECT_GE(trial.sweeps, kLeastCompared);
  EXPECT_LE(10 * trial.better, 3 * trial.sweeps);
  EXPECT_FALSE(trial.raw());
  EXPECT_TRUE(trial.compensated());
}

TEST(CompensationTrial, TimedSweepsAreTriedWithTheirTimes) {
  for (const bool is_raw : {false, true}) {
    std::vector<Sweep> timed = is_raw ? raw().sweeps : compensated().sweeps;
    for (Sweep& sweep : timed) sweep.times_s = *order_times(sweep.points, kPeriodS);
    const CompensationTrial trial = trial_of(timed);
    EXPECT_EQ(trial.times, PointTimes::kAuto);
    EXPECT_EQ(trial.raw(), is_raw);
    EXPECT_EQ(trial.compensated(), !is_raw);
    // A run takes the times that it is given, and says when it should not.
    const SessionResult run = run_of(timed, PointTimes::kAuto);
    EXPECT_EQ(run.source.warnings.size(), is_raw ? 0U : 1U);
    if (!is_raw) {
      EXPECT_NE(run.source.warnings.at(0).find("try --point-times none"), std::string::npos);
    }
    EXPECT_EQ(poses_of(run), poses_of(run_of(timed, PointTimes::kNone)));
  }
}

TEST(CompensationTrial, DoesNotDependOnThreadsOrBudget) {
  const CompensationTrial usual = trial_of(raw().sweeps);
  for (const int threads : {1, 2, 4}) {
    OdometryConfig config;
    config.threads = threads;
    config.budget.sweep_ms = 5;
    const CompensationTrial trial = trial_of(raw().sweeps, config);
    EXPECT_EQ(trial.sweeps, usual.sweeps);
    EXPECT_EQ(trial.better, usual.better);
  }
}

TEST(CompensationTrial, WhatStandsTellsNothing) {
  const CompensationTrial trial = trial_of(std::vector<Sweep>(kTrialSweeps, raw().sweeps[0]));
  EXPECT_EQ(trial.sweeps, 0U);
  EXPECT_FALSE(trial.raw());
  EXPECT_FALSE(trial.compensated());
}

/// Beam by beam, each from the front on counter-clockwise, as KITTI's files.
std::vector<Sweep> by_beams(std::vector<Sweep> sweeps) {
  const auto place = [](const Eigen::Vector3f& p) {
    const double turn = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x()));
    const double elevation_deg = kDegPerRad * std::atan2(static_cast<double>(p.z()), p.head<2>().cast<double>().norm());
    return std::pair(std::lround(-elevation_deg), turn < 0 ? turn + 2 * std::numbers::pi : turn);
  };
  for (Sweep& sweep : sweeps) {
    std::sort(sweep.points.begin(), sweep.points.end(),
              [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return place(a) < place(b); });
    sweep.intensities.clear();
    sweep.rings.clear();
  }
  return sweeps;
}

TEST(CompensationTrial, PointsInAnotherOrderAreTriedWithTheirAzimuth) {
  const std::vector<Sweep> raw_beams = by_beams(raw().sweeps);
  const CompensationTrial found = trial_of(raw_beams);
  EXPECT_EQ(found.times, PointTimes::kAzimuth);
  EXPECT_GE(found.sweeps, kLeastCompared);
  EXPECT_GE(10 * found.on_cones, 9 * found.sweeps);
  EXPECT_TRUE(found.raw());
  const SessionResult run = run_of(raw_beams, PointTimes::kAuto);
  EXPECT_EQ(run.source.point_times, "azimuth, clockwise, period 0.100000 s");
  EXPECT_LT(error_at_end_m(run, raw()), 0.3 * error_at_end_m(run_of(raw_beams, PointTimes::kNone), raw()));

  const std::vector<Sweep> compensated_beams = by_beams(compensated().sweeps);
  const CompensationTrial not_raw = trial_of(compensated_beams);
  EXPECT_EQ(not_raw.times, PointTimes::kAzimuth);
  EXPECT_GE(10 * not_raw.off_cones, 9 * not_raw.sweeps);
  EXPECT_TRUE(not_raw.compensated());
  EXPECT_EQ(poses_of(run_of(compensated_beams, PointTimes::kAuto)),
            poses_of(run_of(compensated_beams, PointTimes::kNone)));
}

TEST(CompensationTrial, NotOfOtherSweeps) {
  std::vector<Sweep> half = by_beams(raw().sweeps);
  for (Sweep& sweep : half) std::erase_if(sweep.points, [](const Eigen::Vector3f& p) { return p.x() < 0; });
  const CompensationTrial trial = trial_of(half);
  EXPECT_EQ(trial.times, PointTimes::kNone);
  EXPECT_EQ(trial.sweeps, 0U);

  OdometryConfig without;
  without.preprocess.deskew = false;
  EXPECT_EQ(trial_of(raw().sweeps, without).sweeps, 0U);
}

// Which is what makes points of a wrong path fit.
TEST(CompensationTrial, NotCertainWhereSweepsAreLost) {
  std::vector<Sweep> torn;
  for (std::size_t i = 0; i < 12; ++i) {
    torn.push_back(raw().sweeps[2 * i]);
    torn.push_back(raw().sweeps[kTrialSweeps - 1]);
    Sweep& half = torn.back();
    half.points.resize(half.points.size() / 2);
    half.intensities.resize(half.points.size());
    half.rings.resize(half.points.size());
  }
  const CompensationTrial trial = trial_of(torn);
  EXPECT_GT(trial.lost, 3U);
  EXPECT_FALSE(trial.certain());
  EXPECT_EQ(trial_of(raw().sweeps).lost, 0U);
  CompensationTrial few_lost{PointTimes::kOrder, 30, 30, 0, 0, 3};
  EXPECT_TRUE(few_lost.raw());
  few_lost.lost = 4;
  EXPECT_FALSE(few_lost.raw());
}

TEST(CompensationTrial, EndsWithTheDataAnErrorOrAnInterrupt) {
  EXPECT_FALSE(trial_of({}).raw());
  EXPECT_FALSE(trial_of({raw().sweeps.begin(), raw().sweeps.begin() + 8}).raw());
  EXPECT_EQ(trial_of(raw().sweeps, {}, [] { return true; }).sweeps, 0U);
  const auto failing = [] { return std::make_unique<SweepsSource>(raw().sweeps, kPeriodS, 20); };
  EXPECT_EQ(try_compensation(failing, 0, {}, {}).sweeps, 17U);
  EXPECT_EQ(try_compensation(failing, 5, {}, {}).sweeps, 12U);
}

TEST(CompensationTrial, ARunTakesRawPointsAsRaw) {
  const SessionResult automatic = run_of(raw().sweeps, PointTimes::kAuto);
  ASSERT_EQ(automatic.failure, nullptr);
  EXPECT_TRUE(automatic.trial.raw());
  EXPECT_EQ(automatic.source.point_times.substr(0, 19), "order of the points");
  std::vector<Sweep> timed = raw().sweeps;
  for (Sweep& sweep : timed) sweep.times_s = *order_times(sweep.points, kPeriodS);
  EXPECT_EQ(poses_of(automatic), poses_of(run_of(timed, PointTimes::kAuto)));
  const SessionResult without = run_of(raw().sweeps, PointTimes::kNone);
  EXPECT_LT(error_at_end_m(automatic, raw()), 0.3 * error_at_end_m(without, raw()));
}

TEST(CompensationTrial, ARunLeavesOthersAsTheyAre) {
  const SessionResult without = run_of(compensated().sweeps, PointTimes::kNone);
  EXPECT_EQ(poses_of(run_of(compensated().sweeps, PointTimes::kAuto)), poses_of(without));
  // As on a robot: nothing is known of the sweeps to come.
  EXPECT_EQ(poses_of(run_of(raw().sweeps, PointTimes::kAuto, true)),
            poses_of(run_of(raw().sweeps, PointTimes::kNone, true)));
}

TEST(CompensationTrial, ObserversAreTold) {
  struct Told final : SessionObserver {
    void on_trial(const CompensationTrial& trial) override { trials.push_back(trial); }
    std::vector<CompensationTrial> trials;
  };
  for (const bool is_raw : {false, true}) {
    SessionOptions options;
    options.point_times = PointTimes::kAuto;
    Session session([&] { return std::make_unique<SweepsSource>(is_raw ? raw().sweeps : compensated().sweeps); },
                    options);
    Told told;
    session.add(told);
    EXPECT_EQ(session.run().results.size(), kTrialSweeps);
    ASSERT_EQ(told.trials.size(), 1U);
    EXPECT_EQ(told.trials[0].raw(), is_raw);
  }
}

}  // namespace
}  // namespace rilo::test
