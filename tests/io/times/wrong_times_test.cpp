// Point times that are wrong, missing, or do not show at once what they are.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/sweep_writer.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

constexpr std::size_t kSweepPoints = 1000;
constexpr std::size_t kWrong = 5;
constexpr std::int64_t kSweepStamp = 1'700'000'000'000'000'000;

Sweep sweep_of(std::size_t points = kSweepPoints) {
  Sweep sweep;
  sweep.stamp_ns = kSweepStamp;
  for (std::size_t i = 0; i < points; ++i) sweep.points.emplace_back(static_cast<float>(i) + 1, 2, 3);
  return sweep;
}

// begin, begin + span · i / kSweepPoints, …
RawTimes times(double begin, double span, ScalarType type = ScalarType::kFloat64) {
  RawTimes raw{"time", type, {}, {}};
  for (std::size_t i = 0; i < kSweepPoints; ++i) {
    raw.floats.push_back(begin + span * static_cast<double>(i) / static_cast<double>(kSweepPoints));
  }
  return raw;
}

RawTimes with_wrong(RawTimes raw, double value) {
  raw.floats[kWrong] = value;
  return raw;
}

PointTimeDecoder decoder_of(double period_s = 0.1) {
  PointTimeHints hints;
  hints.period_s = period_s;
  return PointTimeDecoder(hints);
}

TEST(WrongTimesTest, SinglePointsAreNotUsed) {
  for (const double begin : {0.0, -0.1, 1.7e9}) {
    const RawTimes right = times(begin, 0.1);
    for (const double wrong : {begin + 0.5, begin - 0.5, begin + 0.3, 0.0, 1e300}) {
      if (wrong == 0.0 && begin < 1) continue;
      SCOPED_TRACE(std::to_string(begin) + " " + std::to_string(wrong));
      PointTimeDecoder decoder = decoder_of();
      Sweep expected = sweep_of();
      decoder.decode(right, "a", expected);
      EXPECT_EQ(decoder.warning(), "");
      Sweep sweep = sweep_of();
      decoder.decode(with_wrong(right, wrong), "b", sweep);
      EXPECT_NE(decoder.warning().find("b: 1 of 1000 points"), std::string::npos) << decoder.warning();
      EXPECT_EQ(sweep.stamp_ns, expected.stamp_ns);
      for (std::size_t i = 0; i < kSweepPoints; ++i) {
        EXPECT_EQ(sweep.points[i].allFinite(), i != kWrong);
        EXPECT_EQ(sweep.times_s[i], i == kWrong ? 0 : expected.times_s[i]);
      }
    }
  }
}

TEST(WrongTimesTest, APacketOfThem) {
  RawTimes raw = times(1.7e9, 0.1);
  for (std::size_t i = 500; i < 513; ++i) raw.floats[i] += 40;
  PointTimeDecoder decoder = decoder_of();
  Sweep sweep = sweep_of();
  decoder.decode(raw, "a", sweep);
  EXPECT_NE(decoder.warning().find("13 of 1000"), std::string::npos);
  EXPECT_EQ(sweep.stamp_ns, kSweepStamp);
}

TEST(WrongTimesTest, ManyAreAFault) {
  RawTimes raw = times(0, 0.1);
  for (std::size_t i = 0; i < 100; ++i) raw.floats[i] = 7;
  PointTimeDecoder decoder = decoder_of();
  Sweep sweep = sweep_of();
  decoder.decode(times(0, 0.1), "a", sweep);
  expect_io_error([&] { decoder.decode(raw, "b", sweep); }, {"b", "at most 2.5 s"});
}

// Up to a fiftieth at either end of the times.
TEST(WrongTimesTest, MoreThanAFiftiethAreAFaultToo) {
  for (const std::size_t wrong : {20U, 21U}) {
    RawTimes raw = times(0, 0.1);
    for (std::size_t i = 0; i < wrong; ++i) raw.floats[i] = 7;
    PointTimeDecoder decoder = decoder_of();
    Sweep sweep = sweep_of();
    decoder.decode(times(0, 0.1), "a", sweep);
    const auto decode = [&] { decoder.decode(raw, "b", sweep); };
    if (wrong == 20) {
      decode();
      EXPECT_NE(decoder.warning().find("b: 20 of 1000"), std::string::npos);
    } else {
      expect_io_error(decode, {"b", "at most 2.5 s"});
    }
  }
}

// Longer than the period, and one wrong time: what most of them span counts. The first warning stays.
TEST(WrongTimesTest, OfALongSweepSinglePointsOnly) {
  PointTimeDecoder decoder = decoder_of();
  Sweep sweep = sweep_of();
  decoder.decode(times(0, 0.1), "a", sweep);
  RawTimes raw = with_wrong(times(0, 0.15), 2);
  raw.floats[7] = std::nan("");
  decoder.decode(raw, "b", sweep);
  EXPECT_NE(decoder.warning().find("b: 1 of 1000 points"), std::string::npos) << decoder.warning();
  sweep = sweep_of();
  decoder.decode(with_wrong(raw, 2.1), "c", sweep);
  EXPECT_EQ(decoder.warning().find("c:"), std::string::npos) << decoder.warning();
}

// From 1.6 times the period on.
TEST(WrongTimesTest, ALittleTooLongIsNotSaid) {
  for (const auto& [span, said] : {std::pair(0.155, false), {0.165, true}}) {
    PointTimeDecoder decoder = decoder_of();
    Sweep sweep = sweep_of();
    decoder.decode(times(0, 0.1), "a", sweep);
    decoder.decode(times(0, span), "b", sweep);
    EXPECT_EQ(decoder.warning().empty(), !said) << decoder.warning();
  }
}

TEST(WrongTimesTest, TooLongIsSaid) {
  RawTimes raw = times(0, 0.1);
  for (std::size_t i = 0; i < 100; ++i) raw.floats[i] = 0.5;
  PointTimeDecoder decoder = decoder_of();
  Sweep sweep = sweep_of();
  decoder.decode(times(0, 0.1), "a", sweep);
  decoder.decode(raw, "b", sweep);
  EXPECT_NE(decoder.warning().find("b: the times of its points span 0.49 s"), std::string::npos) << decoder.warning();
}

TEST(WrongTimesTest, PointsInFewDirectionsAreRight) {
  // Most of the points where a wall is, the others anywhere in the sweep.
  RawTimes raw = times(0.04, 0.002);
  raw.floats[0] = 0;
  raw.floats[1] = 0.1;
  PointTimeDecoder decoder = decoder_of();
  Sweep first = sweep_of();
  decoder.decode(times(0, 0.1), "a", first);
  Sweep sweep = sweep_of();
  decoder.decode(raw, "b", sweep);
  EXPECT_EQ(decoder.warning(), "");
  EXPECT_EQ(sweep.times_s[1], 0.1F);
}

TEST(WrongTimesTest, TheUnitIsThatOfMostTimes) {
  PointTimeDecoder seconds = decoder_of();
  Sweep sweep = sweep_of();
  seconds.decode(with_wrong(times(0, 0.1, ScalarType::kFloat32), 0.9), "a", sweep);
  EXPECT_EQ(seconds.convention()->unit, Unit::kSeconds);
  PointTimeDecoder fractions = decoder_of();
  sweep = sweep_of();
  fractions.decode(with_wrong(times(0, 1, ScalarType::kFloat32), 5), "a", sweep);
  EXPECT_EQ(fractions.convention()->unit, Unit::kFraction);
  EXPECT_TRUE(std::isnan(sweep.points[kWrong].x()));
}

TEST(WrongTimesTest, AToldUnitThatCannotBe) {
  const auto told = [](Unit unit) {
    PointTimeHints hints;
    hints.unit = unit;
    hints.period_s = 0.1;
    return PointTimeDecoder(hints);
  };
  Sweep sweep = sweep_of();
  expect_io_error([&] { told(Unit::kNanoseconds).decode(times(0, 0.1), "a", sweep); },
                  {"in ns", "(--point-time-unit) to s"});
  expect_io_error([&] { told(Unit::kSeconds).decode(times(0, 1), "a", sweep); }, {"(--point-time-unit) to fraction"});
  EXPECT_NO_THROW(told(Unit::kSeconds).decode(times(0, 0.001), "a", sweep));
}

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

TEST(WrongTimesTest, ASliverFirst) {
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

TEST(WrongTimesTest, NoTimesInTheFirstSweeps) {
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

TEST(WrongTimesTest, TheSameForAllPointsIsNone) {
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

TEST(WrongTimesTest, TheSameForAllPointsInAToldUnit) {
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

TEST(WrongTimesTest, AClockThatStartsAtZero) {
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

TEST(WrongTimesTest, HalvesThatCountFromTheWholeSweep) {
  const auto halves = [](std::size_t k, float part) { return 0.05F * (static_cast<float>(k % 2) + part); };
  const TempDir folder;
  const auto source = recording(folder, drive(12, halves));
  const auto read = sweeps_of(*source);
  ASSERT_EQ(read.size(), 12U);
  EXPECT_FLOAT_EQ(read[1].times_s[0], 0.05F);
  EXPECT_EQ(read[1].stamp_ns, kSweepStamp + 100'000'000);
}

TEST(WrongTimesTest, MessagesWithoutStamps) {
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

TEST(WrongTimesTest, FractionsOfAThinnedTopic) {
  auto sweeps = drive(4, [](std::size_t, float part) { return part; });
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    sweeps[k].stamp_ns = kSweepStamp + static_cast<std::int64_t>(k) * 300'000'000;
  const TempDir folder;
  const auto source = recording(folder, sweeps);
  sweeps_of(*source);
  EXPECT_TRUE(has_warning(source->info(), "fractions of 0.3 s"));
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
