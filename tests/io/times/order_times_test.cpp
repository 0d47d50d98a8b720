// Times of points that lie in the order of measurement.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "io/io_test_util.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kColumns = 900;
constexpr std::size_t kRings = 16;
constexpr double kPeriod = 0.2;

struct Measured {
  std::vector<Eigen::Vector3f> points;
  std::vector<double> fractions;  // of the sweep, when each was measured
};

/// Columns of points as a sensor measures them that turns by `swept` radians from `seam` on; positive:
/// counter-clockwise.
Measured spinning(double seam, double swept, const std::function<bool(double fraction)>& returns = {}) {
  Measured measured;
  for (std::size_t c = 0; c < kColumns; ++c) {
    const double fraction = static_cast<double>(c) / kColumns;
    if (returns && !returns(fraction)) continue;
    for (std::size_t r = 0; r < kRings; ++r) {
      const double azimuth = seam + swept * fraction + 0.1 * static_cast<double>(r % 4);  // columns are not plumb
      const double range = 5.0 + static_cast<double>((7 * c + r) % 20);
      measured.points.emplace_back(static_cast<float>(range * std::cos(azimuth)),
                                   static_cast<float>(range * std::sin(azimuth)), static_cast<float>(r) - 8.0F);
      measured.fractions.push_back(fraction);
    }
  }
  return measured;
}

/// Of all but 2 % of the points: those of the block in which a part of the turn is missing are between its ends.
double error(const Measured& measured) {
  const auto times = order_times(measured.points, kPeriod);
  if (!times || times->size() != measured.points.size()) return std::numeric_limits<double>::infinity();
  const auto [first, last] = std::minmax_element(measured.fractions.begin(), measured.fractions.end());
  std::vector<double> errors;
  for (std::size_t i = 0; i < times->size(); ++i) {
    const double share = (measured.fractions[i] - *first) / (*last - *first);
    errors.push_back(std::abs(static_cast<double>((*times)[i]) / kPeriod - share));
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() * 98 / 100];
}

TEST(OrderTimes, AreThoseOfTheTurnWhateverDirectionSeamAndAngle) {
  for (const double direction : {-1.0, 1.0}) {
    for (const double seam : {0.0, 0.7, -3.1}) {
      for (const double degrees : {120.0, 360.0, 363.0, 400.0}) {
        EXPECT_LT(error(spinning(seam, direction * degrees / 360 * kTurn)), 0.003)
            << direction << " " << seam << " " << degrees;
      }
    }
  }
}

// What does not return is not there: the angle counts, not the number of points.
TEST(OrderTimes, FollowTheAngleWhereReturnsAreMissing) {
  const auto covered = [](double fraction) { return fraction < 0.3 || fraction > 0.6; };
  EXPECT_LT(error(spinning(1.0, -kTurn, covered)), 0.005);
  const auto thinned = [](double fraction) { return fraction < 0.5 || std::lround(fraction * kColumns) % 5 == 0; };
  EXPECT_LT(error(spinning(1.0, kTurn, thinned)), 0.01);
}

TEST(OrderTimes, NotANumberIsTimedByItsPlace) {
  Measured measured = spinning(2.0, -kTurn);
  for (std::size_t i = 0; i < measured.points.size(); i += 3) {
    measured.points[i].setConstant(i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F);
  }
  EXPECT_LT(error(measured), 0.002);
}

// Some drivers write the height of the laser instead of zeros where nothing returned, with noise.
TEST(OrderTimes, NearTheAxisIsTimedByItsPlace) {
  Measured measured = spinning(2.0, -kTurn);
  for (std::size_t i = 0; i < measured.points.size(); ++i) {
    const float side = i % 2 == 0 ? 0.09F : -0.09F;
    if (i % 5 < 3) measured.points[i] = {i % 3 == 0 ? side : 0.0F, i % 3 == 0 ? 0.0F : side, 0.01F};
  }
  EXPECT_LT(error(measured), 0.003);
}

TEST(OrderTimes, NoneWhereTheOrderIsAnother) {
  const Measured turn = spinning(0.0, -kTurn);
  std::vector<Eigen::Vector3f> by_ring;
  for (std::size_t r = 0; r < kRings; ++r) {
    for (std::size_t c = 0; c < kColumns; ++c) by_ring.push_back(turn.points[c * kRings + r]);
  }
  EXPECT_FALSE(order_times(by_ring, kPeriod));

  std::vector<Eigen::Vector3f> shuffled = turn.points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  EXPECT_FALSE(order_times(shuffled, kPeriod));

  std::vector<Eigen::Vector3f> there_and_back = turn.points;
  there_and_back.insert(there_and_back.end(), turn.points.rbegin(), turn.points.rend());
  EXPECT_FALSE(order_times(there_and_back, kPeriod));

  std::vector<Eigen::Vector3f> two_echoes = turn.points;
  two_echoes.insert(two_echoes.end(), turn.points.begin(), turn.points.end());
  EXPECT_FALSE(order_times(two_echoes, kPeriod));
}

// 128 blocks of 8 points, 2.8° apart: a pair of them that changed places turns back once.
TEST(OrderTimes, OfTheStepsOneInTwentyMayBeWrong) {
  const auto swapped = [](std::size_t pairs) {
    std::vector<Eigen::Vector3f> points;
    for (std::size_t block = 0; block < 128; ++block) {
      const std::size_t place = block >= 128 - 2 * pairs ? block ^ 1U : block;
      const double azimuth = kTurn * static_cast<double>(place) / 128;
      points.insert(points.end(), 8, Eigen::Vector3d(9 * std::cos(azimuth), 9 * std::sin(azimuth), 0).cast<float>());
    }
    return points;
  };
  const auto times = order_times(swapped(6), kPeriod);  // of 127 steps
  ASSERT_TRUE(times);
  EXPECT_GE(*std::min_element(times->begin(), times->end()), 0);
  EXPECT_LE(*std::max_element(times->begin(), times->end()), static_cast<float>(kPeriod));
  EXPECT_FALSE(order_times(swapped(7), kPeriod));
  std::vector<Eigen::Vector3f> fewer = swapped(0);
  EXPECT_TRUE(order_times(fewer, kPeriod));
  fewer.pop_back();
  EXPECT_FALSE(order_times(fewer, kPeriod));
}

TEST(OrderTimes, NoneWhereNothingCanBeTold) {
  EXPECT_FALSE(order_times({}, kPeriod));
  EXPECT_FALSE(order_times({{1, 2, 3}}, kPeriod));
  EXPECT_FALSE(order_times(spinning(0, 0).points, kPeriod));           // one direction
  EXPECT_FALSE(order_times(spinning(0, kTurn / 10).points, kPeriod));  // 36°
  EXPECT_FALSE(order_times(std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f(0, 0, 3)), kPeriod));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(order_times(std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f(nan, 0, 3)), kPeriod));
}

std::unique_ptr<ScanSource> timed_by_order(const std::vector<std::vector<Eigen::Vector3f>>& clouds) {
  std::vector<Sweep> sweeps(clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) sweeps[i].points = clouds[i];
  return detail::with_order_times(std::make_unique<SweepsSource>(std::move(sweeps), kPeriod));
}

TEST(OrderTimes, OfASource) {
  const Measured turn = spinning(0.4, -kTurn);
  const std::vector<Eigen::Vector3f> few(turn.points.begin(), turn.points.begin() + 100);
  EXPECT_TRUE(timed_by_order({{}, turn.points})->next()->times_s.empty());  // no points, no error
  const auto source = timed_by_order({turn.points, few, {}});
  EXPECT_TRUE(source->info().has_point_times);
  EXPECT_EQ(source->info().point_times, "order of the points, period 0.200000 s");
  EXPECT_EQ(source->next()->times_s, *order_times(turn.points, kPeriod));
  // Most of the sensor is covered: by place.
  const auto sweep = source->next();
  ASSERT_EQ(sweep->times_s.size(), few.size());
  EXPECT_FLOAT_EQ(sweep->times_s[50], 0.1F);
  EXPECT_TRUE(source->next()->times_s.empty());
  EXPECT_FALSE(source->next());
}

TEST(OrderTimes, ASourceInAnotherOrderIsAnError) {
  std::vector<Eigen::Vector3f> shuffled = spinning(0.4, -kTurn).points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(2));
  const auto source = timed_by_order({shuffled});
  expect_io_error([&] { source->next(); }, {"sweep 0", "do not lie in the order", "azimuth", "none"});
}

}  // namespace
}  // namespace rilo::test
