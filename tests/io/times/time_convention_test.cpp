// Unit and reference of a time field, by its name, type and values; what is ambiguous.
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/times/raw_times.hpp"
#include "io/times/untimed_sweep.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::test {
namespace {

using Unit = PointTimeUnit;
using Reference = PointTimeReference;

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
  const std::vector<float> relative{0, 0.05F, 0.1F};
  constexpr std::int64_t kEpochNs = 1'600'000'000'000'000'000;
  using T = ScalarType;
  return {
      {"Ouster t",
       integers("t", T::kUint32, {0, 50'000'000, 100'000'000}),
       {},
       {Unit::kNanoseconds, Reference::kStamp},
       kSweepStamp,
       relative},
      {"Ouster t of a narrow sector",
       integers("t", T::kUint32, {0, 1'000, 2'000}),
       {},
       {Unit::kNanoseconds, Reference::kStamp},
       kSweepStamp,
       {0, 1e-6F, 2e-6F}},
      {"Livox offset_time",
       integers("offset_time", T::kUint32, {0, 50'000'000, 100'000'000}),
       0.1,
       {Unit::kNanoseconds, Reference::kStamp},
       kSweepStamp,
       relative},
      {"Velodyne time, before the stamp",
       floats("time", T::kFloat32, {-0.1, -0.05, 0}),
       {},
       {Unit::kSeconds, Reference::kStamp},
       kSweepStamp,
       {-0.1F, -0.05F, 0}},
      {"microseconds",
       floats("time", T::kFloat32, {0, 50'000, 100'000}),
       {},
       {Unit::kMicroseconds, Reference::kStamp},
       kSweepStamp,
       relative},
      {"milliseconds",
       floats("t", T::kFloat32, {0, 50, 100}),
       0.1,
       {Unit::kMilliseconds, Reference::kStamp},
       kSweepStamp,
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
       kSweepStamp,
       {0, 0.1F, 0.1998F}},
  };
}

TEST(TimeConventionTest, PolicyTable) {
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

TEST(TimeConventionTest, RefusesWhatIsAmbiguous) {
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

TEST(TimeConventionTest, ExtremeIntegersDoNotOverflow) {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  expect_refused(integers("time", ScalarType::kInt64, {kLeast, kMost}), {}, {"point_time_unit"});
  expect_refused(integers("time", ScalarType::kUint64, {kMost - 100'000, kMost}), {}, {"64 bits of ns"});
}

}  // namespace
}  // namespace rilo::test
