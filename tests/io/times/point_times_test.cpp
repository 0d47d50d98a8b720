#include "rilo/io/point_times.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "io/io_test_util.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

RawTimes floats(const std::string& field, ScalarType type, std::vector<double> values) {
  if (type == ScalarType::kFloat32) {
    for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  }
  return {field, type, std::move(values), {}};
}
RawTimes integers(const std::string& field, ScalarType type, std::vector<std::int64_t> values) {
  return {field, type, {}, std::move(values)};
}

Sweep sweep_of(std::size_t points) {
  Sweep sweep;
  sweep.stamp_ns = 5'000'000'000;
  for (std::size_t i = 0; i < points; ++i) sweep.points.emplace_back(static_cast<float>(i) + 1, 2, 3);
  return sweep;
}

struct Case {
  std::string name;
  RawTimes raw;
  std::optional<double> period_s;
  PointTimeConvention convention;
  std::int64_t stamp_ns;
  std::vector<float> times_s;
};

// What sensors and drivers write, one row each.
std::vector<Case> table() {
  constexpr std::int64_t kStamp = 5'000'000'000;
  const std::vector<float> relative{0, 0.05F, 0.1F};
  constexpr std::int64_t kEpochNs = 1'600'000'000'000'000'000;
  using T = ScalarType;
  return {
      {"Ouster t",
       integers("t", T::kUint32, {0, 50'000'000, 100'000'000}),
       {},
       {Unit::kNanoseconds, Reference::kStamp},
       kStamp,
       relative},
      {"Ouster t of a narrow sector",
       integers("t", T::kUint32, {0, 1'000, 2'000}),
       {},
       {Unit::kNanoseconds, Reference::kStamp},
       kStamp,
       {0, 1e-6F, 2e-6F}},
      {"Livox offset_time",
       integers("offset_time", T::kUint32, {0, 50'000'000, 100'000'000}),
       0.1,
       {Unit::kNanoseconds, Reference::kStamp},
       kStamp,
       relative},
      {"Velodyne time, before the stamp",
       floats("time", T::kFloat32, {-0.1, -0.05, 0}),
       {},
       {Unit::kSeconds, Reference::kStamp},
       kStamp,
       {-0.1F, -0.05F, 0}},
      {"microseconds",
       floats("time", T::kFloat32, {0, 50'000, 100'000}),
       {},
       {Unit::kMicroseconds, Reference::kStamp},
       kStamp,
       relative},
      {"milliseconds",
       floats("t", T::kFloat32, {0, 50, 100}),
       0.1,
       {Unit::kMilliseconds, Reference::kStamp},
       kStamp,
       relative},
      {"Hesai timestamp",
       floats("timestamp", T::kFloat64, {1.6e9, 1.6e9 + 0.05, 1.6e9 + 0.1}),
       {},
       {Unit::kSeconds, Reference::kEpoch},
       kEpochNs,
       relative},
      {"Livox timestamp",
       floats("timestamp", T::kFloat64, {1.6e18, 1.6e18 + 5e7, 1.6e18 + 1e8}),
       {},
       {Unit::kNanoseconds, Reference::kEpoch},
       kEpochNs,
       relative},
      {"int64 ns, exactly",
       integers("timestamp", T::kInt64, {kEpochNs + 50'000'001, kEpochNs + 1, kEpochNs + 100'000'001}),
       {},
       {Unit::kNanoseconds, Reference::kEpoch},
       kEpochNs + 1,
       {0.05F, 0, 0.1F}},
      {"microseconds since an epoch",
       integers("time", T::kUint64, {1'600'000'000'000'000, 1'600'000'000'100'000, 1'600'000'000'050'000}),
       {},
       {Unit::kMicroseconds, Reference::kEpoch},
       kEpochNs,
       {0, 0.1F, 0.05F}},
      {"seconds since the sensor's start",
       floats("timestamp", T::kFloat64, {12.0, 12.05, 12.1}),
       {},
       {Unit::kSeconds, Reference::kEpoch},
       12'000'000'000,
       relative},
      {"fractions, when the period is known",
       floats("time", T::kFloat32, {0, 0.5, 0.999}),
       0.2,
       {Unit::kFraction, Reference::kStamp},
       kStamp,
       {0, 0.1F, 0.1998F}},
  };
}

TEST(PointTimesTest, PolicyTable) {
  for (const Case& row : table()) {
    SCOPED_TRACE(row.name);
    PointTimeHints hints;
    hints.period_s = row.period_s;
    PointTimeDecoder decoder(hints);
    Sweep sweep = sweep_of(3);
    ASSERT_NO_THROW(decoder.decode(row.raw, "f", sweep));
    EXPECT_EQ(decoder.convention(), row.convention);
    EXPECT_EQ(sweep.stamp_ns, row.stamp_ns);
    ASSERT_EQ(sweep.times_s.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(sweep.times_s[i], row.times_s[i], 3e-7F);
    EXPECT_NE(decoder.description().find(row.raw.field), std::string::npos);
  }
}

void expect_refused(const RawTimes& raw, std::optional<double> period_s,
                    std::initializer_list<std::string_view> parts) {
  PointTimeHints hints;
  hints.period_s = period_s;
  PointTimeDecoder decoder(hints);
  Sweep sweep = sweep_of(raw.size());
  expect_io_error([&] { decoder.decode(raw, "the_file", sweep); }, parts);
}

TEST(PointTimesTest, RefusesWhatIsAmbiguous) {
  using T = ScalarType;
  // Times that begin anew in every packet of a VLP-16.
  expect_refused(integers("time_stamp", T::kUint32, {2303, 1306368}), {},
                 {"the_file", "time_stamp (uint32)", "2303", "1306368", "span of 1304065", "point_time_unit"});
  expect_refused(floats("time", T::kFloat32, {0, 0.99}), {}, {"seconds or fractions", "point_time_unit"});
  expect_refused(floats("time", T::kFloat32, {0, 0.99}), 1.0, {"seconds or fractions"});
  expect_refused(integers("t", T::kUint32, {0, 100'000}), {}, {"nanoseconds by the field's name", "in us"});
  expect_refused(floats("timestamp", T::kFloat32, {1.6e9, 1.6e9 + 128}), {}, {"float32 has steps of", "float64"});
  expect_refused(floats("timestamp", T::kFloat32, {1.6e9, 1.6e9}), {}, {"float32 has steps of"});
  expect_refused(integers("t", T::kUint32, {4'000'000'000, 4'100'000'000}), {}, {"wrap", "point_time_reference"});
  expect_refused(floats("time", T::kFloat64, {7, 7}), {}, {"span of 0"});
  expect_refused(floats("time", T::kFloat64, {-30.1, -30}), {}, {"point_time_reference"});
  expect_refused(floats("time", T::kFloat32, {16384, 16384.1}), {}, {"float32 has steps of"});
  expect_refused(integers("time", T::kInt32, {0, 1}), 1.0, {"a sweep of 0.02 to 1.6 s"});  // whole seconds
  expect_refused(integers("t", T::kUint32, {0, 1'000'000'000}), {}, {"a sweep of 0.01 to 0.55 s"});
  // Ten times too long for the known period.
  expect_refused(floats("time", T::kFloat64, {0, 0.4}), 0.05, {"0.001 to 0.08 s"});
}

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
  EXPECT_EQ(decoded(Unit::kFraction, Reference::kEpoch, floats("t", T::kFloat32, {0, 1})).stamp_ns, 5'000'000'000);
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

TEST(PointTimesTest, ExtremeIntegersDoNotOverflow) {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  expect_refused(integers("time", ScalarType::kInt64, {kLeast, kMost}), {}, {"point_time_unit"});
  expect_refused(integers("time", ScalarType::kUint64, {kMost - 100'000, kMost}), {}, {"64 bits of ns"});
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
