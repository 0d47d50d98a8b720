// Point times of whole recordings that are wrong, missing, or do not show at once what they are.
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/sweep_writer.hpp"
#include "io/times/sweep_period.hpp"
#include "io/times/untimed_sweep.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

// Sweeps 0.1 s apart, with the times that `time_of(sweep, part of the sweep)` gives.
template <typename TimeOf>
std::vector<Sweep> drive(std::size_t sweeps, TimeOf&& time_of) {
  std::vector<Sweep> all;
  for (std::size_t k = 0; k < sweeps; ++k) {
    Sweep sweep = sweep_of();
    sweep.stamp_ns += static_cast<std::int64_t>(k) * 100'000'000;
    for (std::size_t i = 0; i < kSweepPoints; ++i) {
      sweep.times_s.push_back(time_of(k, static_cast<float>(i) / static_cast<float>(kSweepPoints)));
    }
    all.push_back(std::move(sweep));
  }
  return all;
}

std::unique_ptr<ScanSource> recording(const TempDir& folder, const std::vector<Sweep>& sweeps,
                                      const SourceOptions& options = {}) {
  const auto messages = recorded(sweeps, MessageEncoding::kCdr);
  return open_scan_source(folder.write("r.mcap", mcap_bytes({{"/points", kRos2Type}}, messages, {})), options);
}

std::unique_ptr<ScanSource> files(const TempDir& folder, const std::vector<Sweep>& sweeps,
                                  const SourceOptions& options = {}) {
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const auto file = folder.write("f/" + std::to_string(sweeps[k].stamp_ns) + ".pcd", "");
    write_pcd(file, sweeps[k]);
  }
  return open_scan_source(folder / "f", options);
}

TEST(WrongTimesOfDrivesTest, ASliverFirst) {
  std::vector<Sweep> sweeps = drive(5, [](std::size_t, float part) { return 0.1F * part; });
  sweeps[0].points.resize(13);
  sweeps[0].times_s.resize(13);
  for (const auto& open : {recording, files}) {
    const TempDir folder;
    const auto source = open(folder, sweeps, {});
    const auto read = sweeps_of(*source);
    ASSERT_EQ(read.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(read[k].times_s, sweeps[k].times_s);
  }
}

TEST(WrongTimesOfDrivesTest, NoTimesInTheFirstSweeps) {
  const auto sweeps = drive(6, [](std::size_t k, float part) { return k < 3 ? 0 : 0.1F * part; });
  for (const auto& open : {recording, files}) {
    const TempDir folder;
    const auto source = open(folder, sweeps, {});
    EXPECT_TRUE(source->info().has_point_times);
    const auto read = sweeps_of(*source);
    ASSERT_EQ(read.size(), 6U);
    for (std::size_t k = 3; k < 6; ++k) EXPECT_EQ(read[k].times_s, sweeps[k].times_s);
  }
}

TEST(WrongTimesOfDrivesTest, TheSameForAllPointsIsNone) {
  for (const float same : {0.0F, 7.0F}) {
    const auto sweeps = drive(4, [&](std::size_t k, float) { return same * static_cast<float>(k + 1); });
    for (const auto& open : {recording, files}) {
      const TempDir folder;
      const auto source = open(folder, sweeps, {});
      const auto read = sweeps_of(*source);
      ASSERT_EQ(read.size(), 4U);
      EXPECT_TRUE(read[0].times_s.empty());
      EXPECT_EQ(read[3].stamp_ns, sweeps[3].stamp_ns);
      const SourceInfo info = source->info();
      EXPECT_FALSE(info.has_point_times);
      EXPECT_EQ(info.point_times, "none");
      EXPECT_TRUE(has_warning(info, "field time is the same for all points"));
    }
  }
}

TEST(WrongTimesOfDrivesTest, SecondsSince1970InFloat32AreCalledCoarse) {
  const auto sweeps = drive(4, [](std::size_t, float) { return 1.6e9F; });
  for (const auto& open : {recording, files}) {
    const TempDir folder;
    const SourceInfo info = open(folder, sweeps, {})->info();
    EXPECT_TRUE(has_warning(info, "float32 has steps of 128 at 1.6e+09")) << info.warnings.size();
  }
}

TEST(WrongTimesOfDrivesTest, TheSameForAllPointsInAToldUnit) {
  SourceOptions options;
  options.point_time_unit = Unit::kSeconds;
  const TempDir folder;
  const auto source = recording(folder, drive(3, [](std::size_t, float) { return 1.0F; }), options);
  EXPECT_EQ(source->next()->times_s, std::vector<float>(kSweepPoints, 1.0F));
  // Zeros tell nothing in any unit, and stamps are what they are.
  const TempDir other;
  const auto zeros = recording(other, drive(3, [](std::size_t, float) { return 0.0F; }), options);
  EXPECT_TRUE(zeros->next()->times_s.empty());
  options.point_time_reference = Reference::kEpoch;
  const TempDir third;
  const auto stamps =
      recording(third, drive(3, [](std::size_t k, float) { return 0.25F * static_cast<float>(k + 1); }), options);
  EXPECT_EQ(stamps->next()->stamp_ns, 250'000'000);
}

TEST(WrongTimesOfDrivesTest, AClockThatStartsAtZero) {
  const auto clock = [](std::size_t k, float part) { return 0.1F * (static_cast<float>(k) + part); };
  for (const auto& open : {recording, files}) {
    const TempDir folder;
    const auto source = open(folder, drive(40, clock), {});
    const auto read = sweeps_of(*source);
    ASSERT_EQ(read.size(), 40U);
    for (std::size_t k = 0; k < 40; ++k) {
      EXPECT_NEAR(static_cast<double>(read[k].stamp_ns), 1e8 * static_cast<double>(k), 1e3);
      EXPECT_NEAR(read[k].times_s.back(), 0.0999F, 1e-5F);
    }
  }
}

// What the times mean is learnt from those that can be read.
TEST(WrongTimesOfDrivesTest, FirstFilesThatCannotBeRead) {
  const auto clock = [](std::size_t k, float part) { return 0.1F * (static_cast<float>(k) + part); };
  const auto sweeps = drive(8, clock);
  const TempDir folder;
  files(folder, sweeps);
  for (std::size_t k = 0; k < 2; ++k) folder.write("f/" + std::to_string(sweeps[k].stamp_ns) + ".pcd", "");
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  options.read_ahead = 0;
  const auto source = open_scan_source(folder / "f", options);
  EXPECT_TRUE(source->info().has_point_times);
  EXPECT_EQ(source->info().fields.size(), 4U);
  const auto read = sweeps_of(*source);
  ASSERT_EQ(read.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(static_cast<double>(read[k].stamp_ns), 1e8 * static_cast<double>(k + 2), 1e3);
  }
  EXPECT_EQ(source->info().bad_sweeps, 2U);
}

// Sweeps of a clock that starts at 500 s (in float32 near enough), where some have no times: NaN points in a dropout.
std::vector<Sweep> with_dropouts(std::size_t count, double step_s, std::initializer_list<std::size_t> dropouts) {
  auto sweeps = drive(count, [&](std::size_t k, float part) {
    return 500 + static_cast<float>(step_s) * (static_cast<float>(k) + part);
  });
  for (const std::size_t k : dropouts) {
    sweeps[k].times_s.assign(kSweepPoints, 0.0F);
    sweeps[k].points.assign(kSweepPoints, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    sweeps[k].points[0] = Eigen::Vector3f(static_cast<float>(k) + 1, 2, 3);  // told apart
  }
  return sweeps;
}

void expect_even(const std::vector<Sweep>& read, std::size_t count, double step_s) {
  ASSERT_EQ(read.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_NEAR(static_cast<double>(read[k].stamp_ns) * 1e-9, 500 + step_s * static_cast<double>(k), 0.05 * step_s)
        << k;
  }
}

TEST(WrongTimesOfDrivesTest, SweepsWithoutTimesAmongThoseThatTheirPointsStamp) {
  for (const auto& open : {recording, files}) {
    const TempDir folder;
    const auto source = open(folder, with_dropouts(20, 0.1, {0, 1, 6, 12, 13, 19}), {});
    expect_even(sweeps_of(*source), 20, 0.1);
    EXPECT_EQ(source->info().faults, StampFaults{});
  }
}

// Names that are no stamps: the assumed rate is not the true one.
TEST(WrongTimesOfDrivesTest, SweepsWithoutTimesWhereTheRateIsAssumed) {
  for (const double step_s : {0.05, 0.1, 0.14}) {
    const auto sweeps = with_dropouts(20, step_s, {0, 1, 6, 12, 13, 19});
    const TempDir folder;
    for (std::size_t k = 0; k < sweeps.size(); ++k) write_pcd(folder / (std::to_string(k) + ".pcd"), sweeps[k]);
    SourceOptions options;
    options.parts = 1;  // these few points have other directions in each sweep
    const auto source = open_scan_source(folder.path(), options);
    expect_even(sweeps_of(*source), 20, step_s);
    EXPECT_EQ(source->info().faults, StampFaults{});
    const auto later = open_scan_source(folder.path(), options);
    later->skip(12);
    EXPECT_NEAR(static_cast<double>(later->next()->stamp_ns) * 1e-9, 500 + 12 * step_s, 0.05 * step_s);
  }
}

TEST(WrongTimesOfDrivesTest, HalvesThatCountFromTheWholeSweep) {
  const auto halves = [](std::size_t k, float part) { return 0.05F * (static_cast<float>(k % 2) + part); };
  const TempDir folder;
  const auto source = recording(folder, drive(12, halves));
  const auto read = sweeps_of(*source);
  ASSERT_EQ(read.size(), 12U);
  EXPECT_FLOAT_EQ(read[1].times_s[0], 0.05F);
  EXPECT_EQ(read[1].stamp_ns, kSweepStamp + 100'000'000);
}

TEST(WrongTimesOfDrivesTest, MessagesWithoutStamps) {
  const auto right = drive(14, [](std::size_t, float part) { return 0.1F * part; });
  auto messages = recorded(right, MessageEncoding::kCdr);
  for (std::size_t k = 0; k < right.size(); ++k) {
    Sweep sweep = right[k];
    sweep.stamp_ns = 0;
    messages[k].bytes = message_bytes(message_of(sweep), MessageEncoding::kCdr);
  }
  const Topics topics{{"/points", kRos2Type}};
  const TempDir folder;
  auto source = open_scan_source(folder.write("r.mcap", mcap_bytes(topics, messages, {})));
  auto read = sweeps_of(*source);
  ASSERT_EQ(read.size(), 14U);
  EXPECT_EQ(read[13].stamp_ns, messages[13].received_ns);
  SourceInfo info = source->info();
  ASSERT_EQ(info.warnings.size(), 1U);
  EXPECT_TRUE(has_warning(info, "no stamps: the times when they were recorded"));
  EXPECT_EQ(info.faults, StampFaults{});
  EXPECT_FALSE(info.stamps_assumed);

  for (auto& message : messages) message.received_ns = 0;
  source = open_scan_source(folder.write("z.mcap", mcap_bytes(topics, messages, {})));
  read = sweeps_of(*source);
  ASSERT_EQ(read.size(), 14U);
  EXPECT_EQ(read[13].stamp_ns, 1'300'000'000);
  info = source->info();
  EXPECT_TRUE(has_warning(info, "assuming 10 Hz"));
  EXPECT_TRUE(info.stamps_assumed);
  EXPECT_EQ(info.faults, StampFaults{});
}

TEST(WrongTimesOfDrivesTest, FractionsOfAThinnedTopic) {
  auto sweeps = drive(4, [](std::size_t, float part) { return part; });
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    sweeps[k].stamp_ns = kSweepStamp + static_cast<std::int64_t>(k) * 300'000'000;
  const TempDir folder;
  const auto source = recording(folder, sweeps);
  EXPECT_FLOAT_EQ(source->next()->times_s[500], 0.05F);
  EXPECT_TRUE(has_warning(source->info(), "a turn is taken to last 0.1 s"));
  const TempDir other;
  const auto usual = recording(other, drive(4, [](std::size_t, float part) { return part; }));
  EXPECT_FLOAT_EQ(usual->next()->times_s[500], 0.05F);
  EXPECT_TRUE(usual->info().warnings.empty());
}

TEST(OddPeriodTest, From5MillisecondsTo2SecondsAreUsual) {
  for (const auto& [period_s, odd] : {std::pair(0.0049, true), {0.005, false}, {2.0, false}, {2.1, true}}) {
    SourceInfo info;
    info.period_s = period_s;
    detail::note_odd_period("times.txt", info);
    EXPECT_EQ(info.warnings.size(), odd ? 1U : 0U) << period_s;
  }
}

TEST(OddPeriodTest, StampsInAnotherUnit) {
  const TempDir folder;
  write_sequence(folder, 4, "0\n100\n200\n300\n");
  EXPECT_TRUE(has_warning(open_scan_source(folder.path())->info(), "times.txt say that there is a sweep every 100 s"));
  folder.write("times.txt", "0\n0.1\n0.2\n0.3\n");
  EXPECT_TRUE(open_scan_source(folder.path())->info().warnings.empty());
}

}  // namespace
}  // namespace rilo::test
