// What two sweeps have in common counts by the space that it fills, not by its points.
#include "odometry/sweep_overlap.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/deskew.hpp"

namespace rilo {
namespace {

constexpr double kOnM = 2.0;
const Eigen::Vector3d kAhead = Eigen::Vector3d::UnitX();

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
                        const MotionState& found) {
  return {{before, first, planes_of(before, first)}, {sweep, found, planes_of(sweep, found)}, kAhead};
}

TEST(SweepOverlaps, WhatIsSpreadOutDecidesAndNotWhatIsDense) {
  const TimedCloud before = street(0.0);
  const TimedCloud sweep = street(kOnM);
  const SweepOverlap overlap = overlap_of(before, state_on(0.0), sweep, state_on(0.0));
  const double at_rest = overlap.at(state_on(0.0), Vector6d::Zero());
  const double there = overlap.at(state_on(kOnM), Vector6d::Zero());
  EXPECT_GT(there, 0.7);
  EXPECT_GT(at_rest, 0.1) << "the lorries";
  EXPECT_LT(at_rest, 0.5 * there);
  EXPECT_GT(there, overlap.at(state_on(kOnM + 2.0 * SweepOverlap::kSigmaM), Vector6d::Zero()));
}

TEST(SweepOverlaps, PlanesAlongTheDirectionAreLeftOut) {
  TimedCloud walls;
  for (double x = -10.0; x < 10.0; x += 0.1) {
    for (double z = -1.0; z < 1.0; z += 0.1) {
      walls.points.push_back(Eigen::Vector3d(x, 4.05, z).cast<float>());
    }
  }
  EXPECT_EQ(overlap_of(walls, state_on(0.0), walls, state_on(0.0)).at(state_on(0.0), Vector6d::Zero()), 0.0);
  const SweepOverlap across({walls, state_on(0.0), planes_of(walls, state_on(0.0))},
                            {walls, state_on(0.0), planes_of(walls, state_on(0.0))}, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(across.at(state_on(0.0), Vector6d::Zero()), 1.0, 0.1) << "they show how far aside";
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
  EXPECT_GT(overlap.at(state_on(kOnM, kSpeed), state_on(0.0, kSpeed).twist), 0.7);
  EXPECT_LT(overlap.at(state_on(kOnM, kSpeed), Vector6d::Zero()), 0.5) << "the first one not";
  EXPECT_LT(overlap.at(state_on(kOnM), state_on(0.0, kSpeed).twist), 0.5) << "the second one not";
}

TEST(SweepOverlaps, NothingHasNothingInCommon) {
  const TimedCloud some = street(0.0);
  const TimedCloud one{{Eigen::Vector3f(1.0F, 2.0F, 3.0F)}};
  for (const TimedCloud& other : {TimedCloud{}, one}) {
    EXPECT_EQ(overlap_of(some, state_on(0.0), other, state_on(0.0)).at(state_on(0.0), Vector6d::Zero()), 0.0);
    EXPECT_EQ(overlap_of(other, state_on(0.0), some, state_on(0.0)).at(state_on(0.0), Vector6d::Zero()), 0.0);
  }
}

}  // namespace
}  // namespace rilo
