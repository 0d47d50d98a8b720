// The sentence about a rate that cannot be that of the sweeps.
#include "session/assumed_rate.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"
#include "rilo/session/session_observer.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "session/compensation_trial.hpp"

namespace rilo::test {
namespace {

std::string said_of(const std::vector<SweepResult>& results, bool assumed = true, const RateTrial& trial = {}) {
  SourceInfo info;
  info.period_s = 0.05;
  info.stamps_assumed = assumed;
  return doubtful_rate(info, results, trial);
}

/// A drive whose last `astray` sweeps have that status.
std::vector<SweepResult> drive(std::size_t sweeps, std::size_t astray, OdometryStatus status) {
  std::vector<SweepResult> results(sweeps);
  for (SweepResult& result : results) result.status = OdometryStatus::kOk;
  if (sweeps > 0) results[0].status = OdometryStatus::kInitialising;
  for (std::size_t i = sweeps - astray; i < sweeps; ++i) results[i].status = status;
  return results;
}

std::vector<SweepResult> jumping_drive(std::size_t sweeps, std::size_t jumps) {
  std::vector<SweepResult> results = drive(sweeps, jumps, OdometryStatus::kOk);
  for (std::size_t i = sweeps - jumps; i < sweeps; ++i) results[i].stats.impossible_motion = true;
  return results;
}

TEST(AssumedRate, IsDoubtedWhereManySweepsLieTooFarOn) {
  EXPECT_EQ(said_of(jumping_drive(40, 3)),
            "3 of 40 sweeps are lost, or lie where no sensor can have moved to since the sweep before: the data has no "
            "timestamps, and the 20 Hz assumed may be wrong; give --rate, the sweeps a second");
  EXPECT_EQ(said_of(jumping_drive(40, 2)), "");
  EXPECT_NE(said_of(jumping_drive(500, 10)), "");
  EXPECT_EQ(said_of(jumping_drive(500, 9)), "") << "missing sweeps do that now and then";
  EXPECT_EQ(said_of(jumping_drive(40, 20), false), "") << "stamps of the data";
  EXPECT_EQ(said_of({}), "");
}

TEST(AssumedRate, SaysWhatWasTriedInVain) {
  EXPECT_EQ(said_of(jumping_drive(40, 3), true, {20.0, 40, 3, 2}),
            "3 of 40 sweeps are lost, or lie where no sensor can have moved to since the sweep before: the data has no "
            "timestamps, and the 20 Hz assumed may be wrong, or neighbouring sweeps have little in common (at 4 Hz 2 "
            "of the first 40 go astray); give --rate, the sweeps a second");
  EXPECT_EQ(said_of(jumping_drive(40, 3), true, {20.0, 40, 9, 2}), said_of(jumping_drive(40, 3))) << "taken";
}

// Taken for five times as fast as it was, a robot is expected to go on as before: where it turns it is lost.
TEST(AssumedRate, IsDoubtedWhereManySweepsAreLost) {
  for (const OdometryStatus status : {OdometryStatus::kLost, OdometryStatus::kInitialising}) {
    EXPECT_NE(said_of(drive(40, 3, status)), "");
    EXPECT_EQ(said_of(drive(40, 2, status)), "") << "the first sweep is no evidence";
    EXPECT_EQ(said_of(drive(40, 20, status), false), "");
  }
  EXPECT_EQ(said_of(drive(40, 20, OdometryStatus::kDegenerate)), "") << "a tunnel at any rate";
}

/// A car that moves off, seen every `step`-th tenth of a second; stamped as if it had been every one.
std::vector<Sweep> seen_every(std::size_t step, std::size_t sweeps, bool deskewed = true) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = step * sweeps;
  config.deskewed = deskewed;
  const DriveSimulator simulator(config);
  std::vector<Sweep> seen;
  for (std::size_t i = 0; i < sweeps; ++i) {
    seen.push_back(simulator.sweep(step * i).sweep);
    seen.back().stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
    seen.back().times_s.clear();
  }
  return seen;
}

/// Sweeps whose stamps are a guess.
class Unstamped final : public SweepsSource {
 public:
  using SweepsSource::SweepsSource;
  SourceInfo info() const override {
    SourceInfo info = SweepsSource::info();
    info.stamps_assumed = true;
    return info;
  }
};

OpenSource unstamped(const std::vector<Sweep>& sweeps) {
  return [&sweeps] { return std::make_unique<Unstamped>(sweeps); };
}

RateTrial rate_trial_of(const OpenSource& open) { return try_slower_rate(open, 0, 100, {}, {}); }

TEST(SlowerRate, IsTakenWhereHalfAsManySweepsGoAstray) {
  EXPECT_TRUE((RateTrial{10.0, 200, 4, 2}.slower()));
  EXPECT_FALSE((RateTrial{10.0, 200, 4, 3}.slower()));
  EXPECT_FALSE(RateTrial{}.slower()) << "not tried";
  EXPECT_EQ((RateTrial{10.0, 200, 4, 3}.sentence()), "");
  EXPECT_EQ((RateTrial{10.0, 200, 12, 1}.sentence()),
            "the data has no timestamps; at 10 Hz 12 of the first 200 sweeps are lost, or lie where no sensor can have "
            "moved to, at 2 Hz 1: assuming 2 Hz; give --rate, the sweeps a second");
}

TEST(SlowerRate, StretchesStampsAndPeriod) {
  std::vector<Sweep> sweeps(2);
  sweeps[1].stamp_ns = 100'000'000;
  const auto source = detail::with_slower_stamps(std::make_unique<SweepsSource>(sweeps), 5);
  EXPECT_EQ(source->next()->stamp_ns, 0);
  EXPECT_EQ(source->next()->stamp_ns, 500'000'000);
  EXPECT_FALSE(source->next());
  EXPECT_DOUBLE_EQ(source->info().period_s, 0.5);
}

TEST(SlowerRate, IsFoundOfACarThatIsSeenOnceASecond) {
  const std::vector<Sweep> sweeps = seen_every(10, 16);
  const RateTrial trial = rate_trial_of(unstamped(sweeps));
  EXPECT_EQ(trial.sweeps, 16U);
  EXPECT_TRUE(trial.slower()) << trial.astray << " " << trial.slower_astray;

  SessionOptions options;
  options.rate_assumed = true;
  const SessionResult run = Session(unstamped(sweeps), options).run();
  EXPECT_DOUBLE_EQ(run.source.period_s, 0.5);
  EXPECT_EQ(run.results[1].stamp_ns - run.results[0].stamp_ns, 500'000'000);
  ASSERT_FALSE(run.source.warnings.empty());
  EXPECT_EQ(run.source.warnings[0], trial.sentence());
  options.count = 3;
  EXPECT_DOUBLE_EQ(Session(unstamped(sweeps), options).run().source.period_s, 0.5) << "wherever the run ends";
  for (const bool given : {false, true}) {
    options.rate_assumed = !given;
    options.one_pass = !given;
    EXPECT_DOUBLE_EQ(Session(unstamped(sweeps), options).run().source.period_s, 0.1)
        << (given ? "the rate was given" : "a single pass does not look ahead");
  }
}

// At the wrong rate sweeps go astray, and what goes astray does not show whether it is raw.
TEST(SlowerRate, PointsAreTriedAgainAtIt) {
  const std::vector<Sweep> sweeps = seen_every(7, 24, false);
  EXPECT_FALSE(try_compensation(unstamped(sweeps), 0, {}, {}).raw());
  EXPECT_TRUE(try_compensation(unstamped(sweeps), 0, {}, {}, RateTrial::kTimesSlower).raw());
  SessionOptions options;
  options.rate_assumed = true;
  options.point_times = PointTimes::kAuto;
  const SessionResult run = Session(unstamped(sweeps), options).run();
  EXPECT_DOUBLE_EQ(run.source.period_s, 0.5);
  EXPECT_TRUE(run.trial.raw());
  EXPECT_EQ(run.source.point_times, "order of the points, period 0.100000 s") << "a sweep takes no longer";
}

TEST(SlowerRate, IsNotTriedOfARightRateOrOfStamps) {
  const std::vector<Sweep> right = seen_every(1, 16);
  EXPECT_EQ(rate_trial_of(unstamped(right)).sweeps, 0U);
  const std::vector<Sweep> slow = seen_every(10, 16);
  EXPECT_EQ(rate_trial_of([&] { return std::make_unique<SweepsSource>(slow); }).sweeps, 0U);
  EXPECT_EQ(rate_trial_of([] { return std::make_unique<Unstamped>(std::vector<Sweep>{}); }).sweeps, 0U);
}

// What cannot be read is for the run to report.
TEST(SlowerRate, AnErrorEndsTheTrial) {
  const std::vector<Sweep> slow = seen_every(10, 16);
  EXPECT_EQ(rate_trial_of([&] { return std::make_unique<Unstamped>(slow, 0.1, 1); }).sweeps, 0U);
}

}  // namespace
}  // namespace rilo::test
