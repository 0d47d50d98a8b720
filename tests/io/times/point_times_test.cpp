// Point times of a sweep in seconds, from a time field of a known or told convention.
#include "rilo/io/point_times.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "io/io_test_util.hpp"
#include "io/times/raw_times.hpp"
#include "io/times/untimed_sweep.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

TEST(PointTimesTest, ToldUnitAndReference) {
  PointTimeHints hints;
  hints.unit = Unit::kMicroseconds;
  hints.reference = Reference::kEpoch;
  PointTimeDecoder decoder(hints);
  Sweep sweep = sweep_of(2);
  decoder.decode(integers("t", ScalarType::kUint32, {1'000'000, 1'100'000}), "f", sweep);
  EXPECT_EQ(sweep.stamp_ns, 1'000'000'000);
  EXPECT_FLOAT_EQ(sweep.times_s[1], 0.1F);
}

TEST(PointTimesTest, ToldThingsHaveTheirLimits) {
  const auto decoded = [](Unit unit, Reference reference, const RawTimes& raw) {
    PointTimeHints hints;
    hints.unit = unit;
    hints.reference = reference;
    PointTimeDecoder decoder(hints);
    Sweep sweep = sweep_of(2);
    decoder.decode(raw, "f", sweep);
    return sweep;
  };
  using T = ScalarType;
  // A sweep takes no more than 2.5 s, and is no farther than that from its stamp, on either side.
  expect_io_error(
      [&] {
        decoded(Unit::kMicroseconds, Reference::kEpoch, integers("t", T::kInt64, {1'000'000, 3'600'000}));
      },
      {"at most 2.5 s in us"});
  expect_io_error(
      [&] {
        decoded(Unit::kSeconds, Reference::kStamp, floats("t", T::kFloat64, {-2.6, -2.4}));
      },
      {"from the sweep's stamp"});
  // Fractions count from the stamp, whatever is told.
  EXPECT_EQ(decoded(Unit::kFraction, Reference::kEpoch, floats("t", T::kFloat32, {0, 1})).stamp_ns, kSweepStamp);
}

TEST(PointTimesTest, HalfOfTheFractionsShowThatTheyAreSuch) {
  PointTimeHints hints;
  hints.period_s = 0.2;
  PointTimeDecoder decoder(hints);
  Sweep sweep = sweep_of(3);
  decoder.decode(floats("time", ScalarType::kFloat32, {0, 0.25, 0.5}), "f", sweep);
  EXPECT_FLOAT_EQ(sweep.times_s[2], 0.1F);
}

TEST(PointTimesTest, FractionsOfTheAssumedPeriod) {
  PointTimeHints hints;
  hints.unit = Unit::kFraction;
  hints.assumed_period_s = 0.05;
  PointTimeDecoder decoder(hints);
  Sweep sweep = sweep_of(2);
  decoder.decode(floats("u", ScalarType::kFloat32, {0.25, 1}), "f", sweep);
  EXPECT_FLOAT_EQ(sweep.times_s[0], 0.0125F);
  EXPECT_FLOAT_EQ(sweep.times_s[1], 0.05F);
  expect_io_error(
      [&] {
        decoder.decode(floats("u", ScalarType::kFloat32, {0, 1.2}), "f", sweep);
      },
      {"1.2", "fractions of the sweep"});
}

TEST(PointTimesTest, TheFirstDecisionStays) {
  PointTimeDecoder decoder({});
  Sweep sweep = sweep_of(2);
  decoder.decode(floats("time", ScalarType::kFloat64, {0, 0.1}), "a", sweep);
  // A sweep of one instant tells nothing by itself, but the convention is known.
  decoder.decode(floats("time", ScalarType::kFloat64, {0.04, 0.04}), "b", sweep);
  EXPECT_FLOAT_EQ(sweep.times_s[0], 0.04F);
  expect_io_error(
      [&] {
        decoder.decode(floats("time", ScalarType::kFloat64, {100.0, 100.1}), "c", sweep);
      },
      {"c", "100.1", "point_time_reference"});
  expect_io_error([&] { decoder.decode(floats("time", ScalarType::kFloat64, {0, 9}), "c", sweep); }, {"span of 9"});
}

TEST(PointTimesTest, AllZeroTellsNothing) {
  PointTimeDecoder decoder({});
  Sweep sweep = sweep_of(2);
  decoder.decode(floats("time", ScalarType::kFloat32, {0, 0}), "a", sweep);
  EXPECT_EQ(sweep.times_s, (std::vector<float>{0, 0}));
  EXPECT_FALSE(decoder.convention());
  decoder.decode(floats("time", ScalarType::kFloat32, {0, 0.1}), "b", sweep);
  EXPECT_TRUE(decoder.convention());
}

TEST(PointTimesTest, PointsThatAreNoMeasurementTakeNoPart) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr double kNanTime = std::numeric_limits<double>::quiet_NaN();
  PointTimeDecoder decoder({});
  Sweep sweep = sweep_of(5);
  sweep.points[0].setZero();
  sweep.points[1].setConstant(kNan);
  // Zeros among absolute times, and a time that is none.
  decoder.decode(floats("timestamp", ScalarType::kFloat64, {0, 0, 1.6e9, 1.6e9 + 0.1, kNanTime}), "f", sweep);
  EXPECT_EQ(sweep.stamp_ns, 1'600'000'000'000'000'000);
  EXPECT_EQ(sweep.times_s[0], 0);
  EXPECT_EQ(sweep.times_s[1], 0);
  EXPECT_TRUE(sweep.points[0].isZero());
  EXPECT_NEAR(sweep.times_s[3], 0.1F, 1e-6F);
  EXPECT_TRUE(sweep.points[3].allFinite());
  EXPECT_TRUE(std::isnan(sweep.points[4].x()));
  EXPECT_EQ(sweep.times_s[4], 0);
}

TEST(PointTimesTest, NothingMeasured) {
  PointTimeDecoder decoder({});
  Sweep empty;
  decoder.decode(floats("time", ScalarType::kFloat32, {}), "f", empty);
  EXPECT_TRUE(empty.times_s.empty());
  Sweep sweep = sweep_of(2);
  for (auto& point : sweep.points) point.setConstant(std::numeric_limits<float>::quiet_NaN());
  decoder.decode(floats("time", ScalarType::kFloat32, {0, 9e9}), "f", sweep);
  EXPECT_EQ(sweep.times_s, (std::vector<float>{0, 0}));
  EXPECT_FALSE(decoder.convention());
}

TEST(PoseStampTest, TheStampWithinAMicrosecond) {
  EXPECT_EQ(pose_stamp_ns(-594, 0), 0);
  EXPECT_EQ(pose_stamp_ns(1000, 0), 0);
  EXPECT_EQ(pose_stamp_ns(-1000, 0), 0);
  EXPECT_EQ(pose_stamp_ns(1001, 0), 1001);
  EXPECT_EQ(pose_stamp_ns(-1001, 0), -1001);
  EXPECT_EQ(pose_stamp_ns(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()),
            std::numeric_limits<std::int64_t>::max());
}

TEST(AzimuthTimesTest, ClockwiseAndCounterClockwise) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> points{{1, 0, 0},      {0, 2, 1},       {0, -3, 0},
                                            {-4, 1e-6F, 0}, {-4, -1e-6F, 0}, {kNan, 0, 0}};
  const auto clockwise = azimuth_times(points, 0.1, SpinDirection::kClockwise);
  const std::vector<float> expected{0, -0.025F, 0.025F, -0.05F, 0.05F, 0};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(clockwise[i], expected[i], 1e-6F);
  const auto other = azimuth_times(points, 0.1, SpinDirection::kCounterClockwise);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(other[i], -clockwise[i]);
}

}  // namespace
}  // namespace rilo::test
