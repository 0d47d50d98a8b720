// What is said about data, and about sweeps that are of no use.
#include "results/data_survey.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "io/sweeps_source.hpp"
#include "results/live_view.hpp"
#include "results/unusable_sweeps.hpp"

namespace rilo::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

DataSurvey survey(std::vector<Sweep> sweeps, bool all = false) {
  SweepsSource source(std::move(sweeps));
  return survey_of(source, all);
}

std::vector<Sweep> numbered(std::size_t count) {
  std::vector<Sweep> sweeps(count);
  for (std::size_t i = 0; i < count; ++i) sweeps[i].stamp_ns = static_cast<std::int64_t>(i);
  return sweeps;
}

// Every third of a hundred: 0, 3 … 99. The last is looked at in any case.
TEST(DataSurvey, LooksAtAboutFiftySweepsAndAtTheLast) {
  for (const auto& [count, read] : {std::pair(0U, 0U), {50U, 50U}, {100U, 34U}, {101U, 35U}, {102U, 35U}}) {
    const DataSurvey seen = survey(numbered(count));
    EXPECT_EQ(seen.sweeps, count);
    EXPECT_EQ(seen.read, read) << count;
    EXPECT_EQ(seen.complete, count <= 50);
    EXPECT_EQ(seen.stamps.empty() ? 0 : seen.stamps.back() + 1, count);
  }
  EXPECT_EQ(survey(numbered(100), true).read, 100U);
}

TEST(DataSurvey, ExtremesOfAllSweeps) {
  std::vector<Sweep> sweeps(3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  sweeps[0].points = {{5, 0, 0}, {nan, 0, 0}, {0, 5, 0}};
  sweeps[0].times_s = {0.01F, 0.02F, 0.1F};
  sweeps[0].rings = {0, 15, 3};
  sweeps[1].points = {{5, 0, 0}};
  sweeps[1].times_s = {-0.02F};
  sweeps[1].rings = {2};
  for (int k = 0; k < 36; ++k) {
    const double azimuth = (10 * k + 5) * std::numbers::pi / 180;
    sweeps[2].points.emplace_back(static_cast<float>(5 * std::cos(azimuth)), static_cast<float>(5 * std::sin(azimuth)),
                                  0.0F);
  }
  sweeps.push_back(sweeps[0]);
  const DataSurvey seen = survey(std::move(sweeps));
  EXPECT_EQ(seen.least, 1U);
  EXPECT_EQ(seen.most, 36U);
  EXPECT_EQ(seen.points, 3U + 1U + 36U + 3U);
  EXPECT_EQ(seen.not_finite, 2U);
  EXPECT_EQ(seen.times_begin, -0.02F);
  EXPECT_EQ(seen.times_end, 0.1F);
  EXPECT_EQ(seen.rings, 16);
  EXPECT_EQ(seen.sectors_max, 36U);
}

TEST(DataSurvey, CountsThePointsNearTheAxis) {
  std::vector<Sweep> sweeps(2);
  sweeps[0].points = {{5, 0, 0}, {0.05F, -0.05F, 3}, {0, 0, 0}};
  sweeps[1].points = {{0.099F, 0, -1}, {0, 0.101F, 0}, {std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  EXPECT_EQ(survey(std::move(sweeps)).near_axis, 3U);
}

// Drivers of sensors with a window write what did not return a few millimetres off the origin, on all sides.
TEST(DataSurvey, PointsNearTheAxisHaveNoDirection) {
  std::vector<Sweep> sweeps(1);
  sweeps[0].points = {{5, 0.5F, 0}, {0.005F, 0, 0}, {-0.005F, 0.001F, 0}, {0, -0.005F, 2}};
  EXPECT_EQ(survey(std::move(sweeps)).sectors_max, 1U);
}

TEST(UnusableSweeps, AreToldWhenTheyAreATenthWithTheReasonOfTheFirst) {
  PreprocessConfig config;
  config.min_range_m = 1;
  config.max_range_m = 10;
  EXPECT_TRUE(within_range(1, config));
  EXPECT_TRUE(within_range(10, config));
  EXPECT_FALSE(within_range(0.999, config));
  UnusableSweeps observer(config);
  const Odometry odometry{OdometryConfig{}};
  const auto registered = [&](std::size_t points_valid, const std::vector<Eigen::Vector3f>& points) {
    Sweep sweep;
    sweep.points = points;
    SweepResult result;
    result.stats.points_valid = points_valid;
    observer.on_registered({0, sweep, result, odometry});
  };
  registered(0, {{20, 0, 0}, {30, 0, 0}, {40, 0, 0}});
  for (int i = 0; i < 9; ++i) registered(5, {});
  EXPECT_THAT(observer.warning(), HasSubstr("1 of 10 sweeps without a usable point"));
  EXPECT_THAT(observer.warning(), HasSubstr("median range 30.000 m"));
  registered(5, {});
  EXPECT_EQ(observer.warning(), "") << "a sensor that was covered for a while";
  EXPECT_FALSE(observer.all());
  observer.on_restart({});
  EXPECT_EQ(observer.warning(), "");
  registered(0, {});
  EXPECT_TRUE(observer.all());
}

// Truth 10 and 12 m ahead; the first estimate is 5 m to the left and looks there.
TEST(TruthTrack, TheFirstTruePoseIsLaidOntoTheFirstEstimate) {
  const TempDir folder;
  folder.write("poses_mid.txt", "1 0 0 10 0 1 0 0 0 0 1 0\n1 0 0 12 0 1 0 0 0 0 1 0\n");
  TruthTrack track(folder.path());
  SE3 first(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  first.translation().y() = 5;
  EXPECT_LT((track.at(0, first).value() - Eigen::Vector3d(0, 5, 0)).norm(), 1e-12);
  EXPECT_LT((track.at(1, SE3::Identity()).value() - Eigen::Vector3d(0, 7, 0)).norm(), 1e-12);
  EXPECT_FALSE(track.at(2, first));
  track.start_over();
  EXPECT_LT((track.at(1, SE3::Identity()).value() - Eigen::Vector3d(0, 0, 0)).norm(), 1e-12);
}

// Poses at 0, 1, 50 and 100 m; that at 1 m says nothing that the one before it does not.
TEST(FirstSeen, FromTheFirstSweepNearByOrTheNearest) {
  std::vector<SweepResult> results(4);
  results[1].T_odom_lidar.translation().x() = 1;
  results[2].T_odom_lidar.translation().x() = 50;
  results[3].T_odom_lidar.translation().x() = 100;
  EXPECT_THAT(first_seen({{2, 0, 0}, {29, 0, 0}, {31, 0, 0}, {76, 0, 0}, {100, 0, 0}, {500, 0, 0}}, results),
              ElementsAre(0, 0, 2, 2, 3, 3));
  EXPECT_THAT(first_seen({{1, 1, 1}}, {}), ElementsAre(0));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(first_seen({{nan, 0, 0}, {1e12F, 0, 0}, {3, 0, 0}}, results), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace rilo::test
