// What two sweeps have in common counts by the space that it fills, not by its points.
#include "odometry/sweep_overlap.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "cloud/deskew.hpp"

namespace rilo {
namespace {

constexpr double kOnM = 2.0;
const Vector6d kAhead = Vector6d::Unit(3);
const Vector6d kTurning = Vector6d::Unit(2);

MotionState state_on(double x_m, double speed_m_s = 0.0) {
  MotionState state;
  state.T_odom_lidar.translation().x() = x_m;
  state.twist[3] = speed_m_s;
  return state;
}

/// Forty bushes of thirty points, and two lorries of 20 000 points that drive with the sensor, seen from `x_m`.
TimedCloud street(double x_m) {
  TimedCloud cloud;
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> place(-0.45, 0.45);
  for (int bush = -20; bush < 20; ++bush) {
    for (int i = 0; i < 30; ++i) {
      const double x = 1.7 * bush + place(rng) - x_m;
      const double y = (bush % 2 == 0 ? 6.5 : -6.5) + place(rng);
      cloud.points.push_back(Eigen::Vector3d(x, y, 0.5 + place(rng)).cast<float>());
    }
  }
  for (int i = 0; i < 40'000; ++i) {
    const double x = (i % 2 == 0 ? 9.5 : -9.5) + 0.4 * place(rng);
    const double y = 2.0 * place(rng);
    cloud.points.push_back(Eigen::Vector3d(x, y, 0.5 + 2.0 * place(rng)).cast<float>());
  }
  return cloud;
}

LocalMap planes_of(const TimedCloud& cloud, const MotionState& state) {
  LocalMap map((LocalMapConfig()));
  std::vector<Eigen::Vector3f> points;
  deskew(cloud, state.motion(), points);
  map.insert(points, state.T_odom_lidar);
  return map;
}

SweepOverlap overlap_of(const TimedCloud& before, const MotionState& first, const TimedCloud& sweep,
                        const MotionState& found, const Vector6d& motion = kAhead) {
  SweepOverlap overlap({before, first, planes_of(before, first)}, {sweep, found, planes_of(sweep, found)});
  overlap.look_along(motion);
  return overlap;
}

double at(const SweepOverlap& overlap, const MotionState& state, const Vector6d& twist_before = Vector6d::Zero()) {
  return overlap.at(state, overlap.before({twist_before}));
}

TEST(SweepOverlaps, WhatIsSpreadOutDecidesAndNotWhatIsDense) {
  const TimedCloud before = street(0.0);
  const TimedCloud sweep = street(kOnM);
  const SweepOverlap overlap = overlap_of(before, state_on(0.0), sweep, state_on(0.0));
  const double at_rest = at(overlap, state_on(0.0));
  const double there = at(overlap, state_on(kOnM));
  EXPECT_GT(there, 0.7);
  EXPECT_GT(at_rest, 0.1) << "the lorries";
  EXPECT_LT(at_rest, 0.5 * there);
  EXPECT_GT(there, at(overlap, state_on(kOnM + 2.0 * SweepOverlap::kSigmaM)));
}

TEST(SweepOverlaps, PlanesAlongTheDirectionAreLeftOut) {
  TimedCloud walls;
  for (double x = -10.0; x < 10.0; x += 0.1) {
    for (double z = -1.0; z < 1.0; z += 0.1) {
      walls.points.push_back(Eigen::Vector3d(x, 4.05, z).cast<float>());
    }
  }
  const auto in_common = [&](const Vector6d& motion) {
    return at(overlap_of(walls, state_on(0.0), walls, state_on(0.0), motion), state_on(0.0));
  };
  EXPECT_EQ(in_common(kAhead), 0.0);
  EXPECT_NEAR(in_common(Vector6d::Unit(4)), 1.0, 0.1) << "they show how far aside";
  EXPECT_NEAR(in_common(kTurning), 1.0, 0.1) << "and how far it has turned";
}

TEST(SweepOverlaps, WhatIsClearlyMoreIsSoByThreeStandardDeviations) {
  const std::vector<double> none(20, 0.0);
  const auto matched = [](std::size_t places) {
    std::vector<double> matches(20, 0.0);
    std::fill_n(matches.begin(), places, 1.0);
    return matches;
  };
  EXPECT_FALSE(clearly_more(matched(9), none)) << "9 = 3 sqrt(9)";
  EXPECT_TRUE(clearly_more(matched(10), none));
  EXPECT_FALSE(clearly_more(none, matched(10)));
  EXPECT_FALSE(clearly_more(none, none));
}

// Cars of the sensor's own pace match where it stands, the roadside where it drives: many places on either side are
// more than three standard deviations, and still no clear answer.
TEST(SweepOverlaps, WhatIsClearlyMoreHasTwiceAsMuchForIt) {
  const auto matched = [](std::size_t from, std::size_t to) {
    std::vector<double> matches(1000, 0.0);
    std::fill(matches.begin() + static_cast<std::ptrdiff_t>(from), matches.begin() + static_cast<std::ptrdiff_t>(to),
              1.0);
    return matches;
  };
  EXPECT_FALSE(clearly_more(matched(0, 400), matched(400, 600)));
  EXPECT_TRUE(clearly_more(matched(0, 401), matched(400, 600)));
  EXPECT_FALSE(clearly_more(matched(400, 600), matched(0, 401)));
  EXPECT_FALSE(clearly_more(matched(0, 400), matched(400, 500), 4.0));
  EXPECT_TRUE(clearly_more(matched(0, 402), matched(400, 501), 4.0));
}

TEST(SweepOverlaps, OfEqualOnesTheFirstIsTheMost) {
  EXPECT_EQ(most_of({0.1, 0.4, 0.2, 0.4}), 1U);
  EXPECT_EQ(most_of({0.0}), 0U);
}

// Along one direction and then along another it says what one that looked along that direction alone would say.
TEST(SweepOverlaps, LooksAlongOneDirectionAfterTheOther) {
  const TimedCloud before = street(0.0);
  const TimedCloud sweep = street(kOnM);
  SweepOverlap overlap = overlap_of(before, state_on(0.0), sweep, state_on(kOnM));
  for (const Vector6d& motion : {kTurning, kAhead}) {
    overlap.look_along(motion);
    const SweepOverlap alone = overlap_of(before, state_on(0.0), sweep, state_on(kOnM), motion);
    EXPECT_EQ(at(overlap, state_on(1.5)), at(alone, state_on(1.5)));
  }
}

TEST(SweepOverlaps, InARowTheBestPlaceIsFoundWhereverItLies) {
  const auto never = [] { return false; };
  for (std::size_t count = 0; count < 12; ++count) {
    for (std::size_t best = 0; best < count; ++best) {
      const auto overlap_at = [&](std::size_t i) {
        return std::exp(-0.5 * std::pow(static_cast<double>(i) - static_cast<double>(best), 2));
      };
      const std::vector<double> overlaps = overlaps_along(count, overlap_at, never);
      ASSERT_EQ(overlaps.size(), count);
      EXPECT_EQ(most_of(overlaps), best);
      EXPECT_EQ(overlaps[best], 1.0);
    }
  }
  EXPECT_TRUE(overlaps_along(
                  0, [](std::size_t) { return 1.0; }, never)
                  .empty());
}

TEST(SweepOverlaps, InARowHalfOfThePlacesAndThoseBesideTheBestAreLookedAt) {
  std::atomic<int> looks = 0;
  const auto overlap_at = [&](std::size_t i) {
    ++looks;
    return i == 31 ? 1.0 : (i == 30 || i == 32 ? 0.6 : 0.1);
  };
  const std::vector<double> overlaps = overlaps_along(60, overlap_at, [] { return false; });
  EXPECT_EQ(most_of(overlaps), 31U);
  EXPECT_LE(looks, 30 + 8);
  EXPECT_EQ(overlaps[41], 0.0) << "not looked at";
}

// Four places at the beginning of the row have more in common than those around the best pair.
TEST(SweepOverlaps, BothNeighboursOfAPlaceInARowAreLookedAt) {
  for (const std::size_t best : {21U, 23U}) {
    const auto overlap_at = [&](std::size_t i) {
      return i == best ? 1.0 : i == 22 ? 0.9 : i < 8 && i % 2 == 0 ? 0.5 : 0.1;
    };
    EXPECT_EQ(most_of(overlaps_along(40, overlap_at, [] { return false; })), best);
  }
}

/// Half of the points are taken 0.05 s before the pose, half after it.
TimedCloud taken_at(double speed_m_s, TimedCloud cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.offsets_s.push_back(i % 2 == 0 ? -0.05F : 0.05F);
    cloud.points[i].x() -= static_cast<float>(speed_m_s) * cloud.offsets_s.back();
  }
  return cloud;
}

TEST(SweepOverlaps, BothAreCompensatedForTheVelocityOfThePlace) {
  constexpr double kSpeed = 20.0;
  const TimedCloud before = taken_at(kSpeed, street(0.0));
  const TimedCloud sweep = taken_at(kSpeed, street(kOnM));
  const SweepOverlap overlap = overlap_of(before, state_on(0.0), sweep, state_on(kOnM, kSpeed));
  EXPECT_GT(at(overlap, state_on(kOnM, kSpeed), state_on(0.0, kSpeed).twist), 0.7);
  EXPECT_LT(at(overlap, state_on(kOnM, kSpeed)), 0.5) << "the first one not";
  EXPECT_LT(at(overlap, state_on(kOnM), state_on(0.0, kSpeed).twist), 0.5) << "the second one not";
}

TEST(SweepOverlaps, IsTheSameForAnyNumberOfThreads) {
  const TimedCloud before = taken_at(1.0, street(0.0));
  const TimedCloud sweep = taken_at(1.0, street(kOnM));
  const auto matches_with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const SweepOverlap overlap = overlap_of(before, state_on(0.0, 1.0), sweep, state_on(kOnM, 1.0));
    return overlap.matches(state_on(1.5, 1.0), overlap.before({state_on(0.0, 1.0).twist}));
  };
  const std::vector<double> one = matches_with(1);
  EXPECT_GT(mean_match(one), 0.0);
  EXPECT_EQ(matches_with(2), one);
  EXPECT_EQ(matches_with(4), one);
}

TEST(SweepOverlaps, NothingHasNothingInCommon) {
  const TimedCloud some = street(0.0);
  const TimedCloud one{{Eigen::Vector3f(1.0F, 2.0F, 3.0F)}};
  for (const TimedCloud& other : {TimedCloud{}, one}) {
    EXPECT_EQ(at(overlap_of(some, state_on(0.0), other, state_on(0.0)), state_on(0.0)), 0.0);
    EXPECT_EQ(at(overlap_of(other, state_on(0.0), some, state_on(0.0)), state_on(0.0)), 0.0);
  }
}

}  // namespace
}  // namespace rilo
