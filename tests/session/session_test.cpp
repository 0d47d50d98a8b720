// Session: one run over a source, its observers, and what ends it.
#include "rilo/session/session.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/degrees.hpp"
#include "io/sweeps_source.hpp"
#include "rilo/session/session_observer.hpp"
#include "simulation/small_drive.hpp"

namespace rilo::test {
namespace {

constexpr std::size_t kSweeps = 24;

const std::vector<Sweep>& drive() {
  static const std::vector<Sweep> kDrive = small_drive(kSweeps);
  return kDrive;
}

// Warns when the third sweep is read.
class DriveSource final : public SweepsSource {
 public:
  explicit DriveSource(std::size_t fails_at = SIZE_MAX) : SweepsSource(drive(), 0.1, fails_at) {}

  std::optional<Sweep> next() override {
    std::optional<Sweep> sweep = SweepsSource::next();
    if (current_index() == 2) warnings_ = {"the third"};
    return sweep;
  }
  SourceInfo info() const override {
    SourceInfo info = SweepsSource::info();
    info.warnings = warnings_;
    return info;
  }

 private:
  std::vector<std::string> warnings_;
};

std::unique_ptr<ScanSource> open_drive() { return std::make_unique<DriveSource>(); }

// Any estimate counts as certain: a short drive of a sensor without error starts over.
SessionOptions soon_certain() {
  SessionOptions options;
  options.config.elevation.significance = 0;
  return options;
}

std::vector<Eigen::Matrix4d> poses(const SessionResult& run) {
  std::vector<Eigen::Matrix4d> matrices;
  for (const StampedPose& pose : run.trajectory()) matrices.emplace_back(pose.T_odom_lidar.matrix());
  return matrices;
}

class Log final : public SessionObserver {
 public:
  void on_read(const Sweep& sweep, const std::string& name) override {
    read = sweep.stamp_ns;
    names.push_back(name);
  }
  void on_registered(const RegisteredSweep& sweep) override {
    EXPECT_EQ(sweep.sweep.stamp_ns, read);
    EXPECT_EQ(sweep.odometry.trajectory().size(), indices.size() + 1);
    indices.push_back(sweep.index);
  }
  void on_warning(const std::string& warning) override { warnings.push_back(warning); }
  void on_restart(const Restart& restart) override {
    restarts.push_back(restart);
    indices.clear();
  }
  void on_end(const Odometry& odometry) override { points_at_end = odometry.local_map().size(); }

  std::int64_t read = 0;
  std::vector<std::string> names;
  std::vector<std::size_t> indices;
  std::vector<std::string> warnings;
  std::vector<Restart> restarts;
  std::size_t points_at_end = 0;
};

TEST(Session, TellsItsObserversAndGivesAllSweeps) {
  Session session(open_drive, {});
  Log log;
  session.add(log);
  const SessionResult run = session.run();
  ASSERT_EQ(run.failure, nullptr);
  EXPECT_EQ(run.results.size(), kSweeps);
  EXPECT_EQ(run.indices, log.indices);
  EXPECT_EQ(log.names.back(), "sweep " + std::to_string(kSweeps - 1));
  EXPECT_THAT(log.warnings, testing::ElementsAre("the third"));
  EXPECT_GT(log.points_at_end, 0U);
  EXPECT_FALSE(run.interrupted);
  EXPECT_GT(run.wall_s, 0.0);
  EXPECT_GT(run.peak_rss_mb, 1.0);
  EXPECT_GE(run.threads, 1);
  EXPECT_EQ(run.trajectory().back().stamp_ns, run.results.back().stamp_ns);
}

TEST(Session, SecondPassBeginsWithWhatTheFirstSaysAboutTheSensor) {
  Session session(open_drive, soon_certain());
  Log log;
  session.add(log);
  const SessionResult two = session.run();
  ASSERT_EQ(two.failure, nullptr);
  ASSERT_EQ(log.restarts.size(), 1U);
  ASSERT_TRUE(two.restart);
  EXPECT_EQ(two.restart->after_sweeps, kSweeps) << "fewer than the first pass may have";
  EXPECT_EQ(two.restart->elevation_offset_deg, log.restarts[0].elevation_offset_deg);
  EXPECT_NE(two.restart->elevation_offset_deg, 0.0);
  EXPECT_DOUBLE_EQ(kDegPerRad * two.results.front().stats.elevation_applied_rad, two.restart->elevation_offset_deg);
  EXPECT_EQ(two.results.size(), kSweeps);
  EXPECT_EQ(two.config.elevation.initial_deg, 0.0) << "the configuration is the one that was given";

  const SessionResult again = Session(open_drive, soon_certain()).run();
  EXPECT_EQ(poses(again), poses(two));
}

TEST(Session, ACalibrationThatTheSweepsContradictIsNamed) {
  for (const bool contradicts : {false, true}) {
    SessionOptions options;
    options.one_pass = true;
    options.calibration = SensorAngles{};
    options.calibration->name = "old.yaml";
    options.calibration->elevation_estimate = {kRadPerDeg * (contradicts ? 1.0 : 0.1), kRadPerDeg * 0.1};
    Session session(open_drive, options);
    Log log;
    session.add(log);
    const SessionResult run = session.run();
    ASSERT_EQ(run.failure, nullptr);
    const auto named = testing::Contains(testing::StartsWith("old.yaml: its elevation offset, +1.000 ± 0.100 deg"));
    EXPECT_EQ(contradicts, testing::Matches(named)(log.warnings));
    EXPECT_EQ(contradicts, testing::Matches(named)(run.source.warnings));
  }
}

TEST(Session, NothingLearntIsNoReasonToStartOver) {
  SessionOptions options;
  options.config.elevation.enabled = false;
  options.config.beams.enabled = false;
  const SessionResult run = Session(open_drive, options).run();
  EXPECT_FALSE(run.restart);
  EXPECT_EQ(run.results.size(), kSweeps);
  options.one_pass = true;
  EXPECT_EQ(poses(Session(open_drive, options).run()), poses(run));
  options.one_pass = false;
  options.count = 5;
  options.config.elevation.initial_deg = 0.1;  // given, not learnt
  const SessionResult few = Session(open_drive, options).run();
  EXPECT_FALSE(few.restart);
  EXPECT_EQ(few.results.size(), 5U);
}

TEST(Session, OnePassStaysAsItWas) {
  SessionOptions options = soon_certain();
  options.one_pass = true;
  const SessionResult run = Session(open_drive, options).run();
  EXPECT_FALSE(run.restart);
  EXPECT_EQ(run.config.elevation.initial_deg, 0.0);
  EXPECT_NE(run.results.back().stats.elevation_applied_rad, 0.0);
}

TEST(Session, StartAndCountHoldInBothPasses) {
  SessionOptions options = soon_certain();
  options.start = 3;
  options.count = 20;
  const SessionResult run = Session(open_drive, options).run();
  EXPECT_TRUE(run.restart);
  ASSERT_EQ(run.indices.size(), 20U);
  EXPECT_EQ(run.indices.front(), 3U);
  EXPECT_EQ(sweeps_to_do(DriveSource(), 3, 20), 20U);
  EXPECT_EQ(sweeps_to_do(DriveSource(), kSweeps - 2, 20), 2U);
}

TEST(Session, AnInterruptEndsItAfterTheSweep) {
  SessionOptions options;
  std::size_t asked = 0;
  options.interrupted = [&asked] { return ++asked > 4; };
  const SessionResult run = Session(open_drive, options).run();
  EXPECT_TRUE(run.interrupted);
  EXPECT_EQ(run.failure, nullptr);
  EXPECT_EQ(run.results.size(), 4U);
  // Before the first one, too; and what the first pass did is not given up for a second that will not come.
  options.interrupted = [] { return true; };
  const SessionResult nothing = Session(open_drive, options).run();
  EXPECT_EQ(nothing.failure, nullptr);
  EXPECT_TRUE(nothing.results.empty());
  options = soon_certain();
  asked = 0;
  options.interrupted = [&asked] { return ++asked > 20; };
  const SessionResult first_pass = Session(open_drive, options).run();
  EXPECT_FALSE(first_pass.restart);
  EXPECT_EQ(first_pass.results.size(), 20U);
}

// Times of the points that are a little uneven about the stamp: the middle is 0.3 µs later.
TEST(Session, APoseAtTheStampHasTheStamp) {
  Sweep sweep = drive()[0];
  sweep.stamp_ns = 1'700'000'000'123'456'789;
  sweep.times_s.assign(sweep.points.size(), 0.0F);
  sweep.times_s.front() = -0.05F;
  sweep.times_s.back() = 0.0500006F;
  const SessionResult run =
      Session([&] { return std::make_unique<SweepsSource>(std::vector<Sweep>{sweep}); }, {}).run();
  EXPECT_EQ(run.results.at(0).stamp_ns, sweep.stamp_ns);
}

TEST(Session, ASecondPassThatIsEndedEarlyKeepsWhatTheFirstLearnt) {
  SessionOptions options = soon_certain();
  options.one_pass = true;
  const SessionResult first = Session(open_drive, options).run();
  ASSERT_TRUE(std::isfinite(first.learnt.elevation_estimate.sigma_rad));
  EXPECT_EQ(first.learnt_from, kSweeps);

  options.one_pass = false;
  std::size_t asked = 0;
  options.interrupted = [&asked] { return ++asked > kSweeps + 4; };
  const SessionResult run = Session(open_drive, options).run();
  ASSERT_TRUE(run.restart);
  ASSERT_LT(run.results.size(), 10U);
  EXPECT_EQ(run.learnt.elevation_estimate.rad, first.learnt.elevation_estimate.rad);
  EXPECT_EQ(run.learnt.elevation_estimate.sigma_rad, first.learnt.elevation_estimate.sigma_rad);
  EXPECT_EQ(run.learnt_from, kSweeps);

  options.interrupted = {};
  const SessionResult whole = Session(open_drive, options).run();
  EXPECT_NE(whole.learnt.elevation_estimate.rad, first.learnt.elevation_estimate.rad) << "of the second pass";
  EXPECT_EQ(whole.learnt_from, kSweeps);
}

TEST(Session, AnErrorKeepsWhatWasDoneBefore) {
  const SessionResult run = Session([] { return std::make_unique<DriveSource>(5); }, {}).run();
  EXPECT_EQ(run.results.size(), 5U);
  ASSERT_NE(run.failure, nullptr);
  EXPECT_THROW(std::rethrow_exception(run.failure), IoError);
}

TEST(Session, DataThatCannotBeOpenedAgainKeepTheFirstPass) {
  int opened = 0;
  const auto once = [&opened]() -> std::unique_ptr<ScanSource> {
    if (++opened > 1) throw IoError({"drive", "", "nothing", "the data", ""});
    return open_drive();
  };
  const SessionResult run = Session(once, soon_certain()).run();
  EXPECT_NE(run.failure, nullptr);
  EXPECT_FALSE(run.restart);
  EXPECT_GT(run.results.size(), 0U);
}

TEST(Session, AStartPastTheEndIsAnErrorWithBothNumbers) {
  SessionOptions options;
  options.start = 500;
  const SessionResult run = Session(open_drive, options).run();
  try {
    ASSERT_NE(run.failure, nullptr);
    std::rethrow_exception(run.failure);
  } catch (const RunError& error) {
    EXPECT_EQ(error.kind(), RunErrorKind::kBadData);
    EXPECT_THAT(error.what(), testing::HasSubstr("start 500 is past the last of 24 sweeps"));
  }
}

TEST(Session, AConfigurationOutOfRangeIsAnErrorAtOnce) {
  SessionOptions options;
  options.config.threads = -1;
  EXPECT_THROW(Session(open_drive, options), std::invalid_argument);
}

TEST(Session, TheMapIsThatOfTheLastPass) {
  MapObserver two_passes(0.5);
  Session session(open_drive, soon_certain());
  session.add(two_passes);
  const SessionResult run = session.run();
  ASSERT_TRUE(run.restart);

  Odometry odometry(run.config);
  for (const Sweep& sweep : drive()) odometry.register_sweep(sweep);
  odometry.start_over();
  MapObserver second_pass(0.5);
  for (const Sweep& sweep : drive()) {
    const SweepResult result = odometry.register_sweep(sweep);
    second_pass.on_registered({0, sweep, result, odometry});
  }
  EXPECT_EQ(two_passes.cloud(false).points, second_pass.cloud(false).points);
  EXPECT_EQ(two_passes.cloud(true).normals.size(), two_passes.cloud(true).points.size());
  EXPECT_GT(second_pass.cloud(false).points.size(), 1000U);
}

}  // namespace
}  // namespace rilo::test
