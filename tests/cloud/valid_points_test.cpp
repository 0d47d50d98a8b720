// Which points of a sweep are used, and the middle of their times.
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/preprocess.hpp"

namespace rilo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kTiny = std::numeric_limits<float>::denorm_min();

Sweep timed(std::vector<Eigen::Vector3f> points, std::vector<float> times_s) {
  Sweep sweep;
  sweep.stamp_ns = 1'000'000'000;
  sweep.points = std::move(points);
  sweep.times_s = std::move(times_s);
  return sweep;
}

TEST(ValidPointsTest, DropsWhatIsNotFiniteOrOutOfRange) {
  Sweep sweep;
  sweep.points = {{1.0F, 0.0F, 0.0F},   {kNan, 0.0F, 0.0F},    {0.0F, kInf, 0.0F},   {0.0F, 0.0F, -kInf},
                  {0.0F, 0.0F, 0.0F},   {0.4F, 0.0F, 0.0F},    {0.5F, 0.0F, 0.0F},   {0.0F, 100.0F, 0.0F},
                  {0.0F, 100.1F, 0.0F}, {kTiny, kTiny, kTiny}, {3e38F, 3e38F, 0.0F}, {kNan, kNan, kNan}};
  Preprocessor preprocessor{PreprocessConfig{}};
  const PreparedSweep& prepared = preprocessor.prepare(sweep);
  EXPECT_EQ(prepared.valid_points, 3U);  // both limits belong to the range
  for (const Eigen::Vector3f& p : prepared.map_cloud.points) {
    EXPECT_TRUE(p.allFinite());
  }
  EXPECT_FALSE(prepared.source.timed());
}

TEST(ValidPointsTest, NoReturnIsNoPointWithoutALeastRangeEither) {
  PreprocessConfig config;
  config.min_range_m = 0.0;
  Sweep sweep;
  sweep.points = {{0.0F, 0.0F, 0.0F}, {0.01F, 0.0F, 0.0F}, {-0.0F, 0.0F, 0.0F}};
  EXPECT_EQ(Preprocessor(config).prepare(sweep).valid_points, 1U);
}

TEST(ValidPointsTest, TimesCountFromTheMiddleOfTheSweep) {
  Preprocessor preprocessor{PreprocessConfig{}};
  const PreparedSweep& prepared =
      preprocessor.prepare(timed({{5, 0, 0}, {0, 5, 0}, {0, 0, 5}, {-5, 0, 0}}, {0.0F, 0.1F, kNan, 0.025F}));
  EXPECT_EQ(prepared.valid_points, 3U);  // a point without an instant cannot be compensated
  EXPECT_NEAR(static_cast<double>(prepared.mid_stamp_ns), 1.05e9, 10.0);
  ASSERT_EQ(prepared.source.size(), 3U);
  EXPECT_NEAR(prepared.source.offsets_s[0], -0.05F, 1e-7F);
  EXPECT_NEAR(prepared.source.offsets_s[1], 0.05F, 1e-7F);
  EXPECT_NEAR(prepared.source.offsets_s[2], -0.025F, 1e-7F);
}

TEST(ValidPointsTest, AnInstantOfADroppedPointDoesNotCount) {
  Preprocessor preprocessor{PreprocessConfig{}};
  const PreparedSweep& prepared =
      preprocessor.prepare(timed({{5, 0, 0}, {0, 5, 0}, {kNan, 0, 5}, {500, 0, 0}}, {0.0F, 0.1F, 7.0F, kInf}));
  EXPECT_NEAR(static_cast<double>(prepared.mid_stamp_ns), 1.05e9, 10.0);
}

TEST(ValidPointsTest, ATimedSweepWithoutPointsHasTheMiddleOfTheOthers) {
  Preprocessor preprocessor{PreprocessConfig{}};
  EXPECT_EQ(preprocessor.prepare(timed({}, {})).mid_stamp_ns, 1'000'000'000);
  EXPECT_NEAR(static_cast<double>(preprocessor.prepare(timed({{5, 1, 1}, {6, 1, 1}}, {0.0F, 0.1F})).mid_stamp_ns),
              1.05e9, 10.0);
  const Eigen::Vector3f nothing = Eigen::Vector3f::Constant(kNan);
  EXPECT_NEAR(static_cast<double>(preprocessor.prepare(timed({nothing}, {0.02F})).mid_stamp_ns), 1.05e9, 10.0);
}

TEST(ValidPointsTest, JitterOfTheSpanKeepsTheReferenceInstant) {
  Preprocessor preprocessor{PreprocessConfig{}};
  const std::vector<Eigen::Vector3f> points = {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}};
  const std::int64_t mid_ns = preprocessor.prepare(timed(points, {0.0F, 0.05F, 0.1F})).mid_stamp_ns;
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> jitter(0.0F, 0.01F);
  for (int i = 0; i < 50; ++i) {
    const Sweep sweep = timed(points, {jitter(rng), 0.05F, 0.1F - jitter(rng)});
    const PreparedSweep& prepared = preprocessor.prepare(sweep);
    EXPECT_EQ(prepared.mid_stamp_ns, mid_ns);
    EXPECT_NEAR(prepared.source.offsets_s[1], 0.0F, 1e-7F);
  }
  preprocessor.reset();
  EXPECT_NE(preprocessor.prepare(timed(points, {0.0F, 0.05F, 0.08F})).mid_stamp_ns, mid_ns);
}

TEST(ValidPointsTest, TimesAreIgnoredWhenAskedToOrOfTheWrongLength) {
  PreprocessConfig config;
  config.deskew = false;
  Preprocessor off{config};
  const PreparedSweep& ignored = off.prepare(timed({{5, 0, 0}, {0, 5, 0}}, {0.0F, kNan}));
  EXPECT_FALSE(ignored.source.timed());
  EXPECT_EQ(ignored.valid_points, 2U);
  EXPECT_EQ(ignored.mid_stamp_ns, 1'000'000'000);
  Preprocessor on{PreprocessConfig{}};
  EXPECT_FALSE(on.prepare(timed({{5, 0, 0}, {0, 5, 0}}, {0.1F})).source.timed());
}

}  // namespace
}  // namespace rilo
