// Point times of a sweep that are wrong, missing, or do not show at once what they are.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/times/untimed_sweep.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

constexpr std::size_t kWrong = 5;

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

}  // namespace
}  // namespace rilo::test
