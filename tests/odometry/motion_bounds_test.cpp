// How far a sensor can have moved.
#include "odometry/motion_bounds.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

SE3 along_x(double metres) {
  SE3 T = SE3::Identity();
  T.translation().x() = metres;
  return T;
}

SE3 yawed(double radians) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, radians));
  return T;
}

const MotionBoundsConfig kBounds;  // 60 m/s, 30 m/s², 10 rad/s, 50 rad/s²

TEST(MotionBounds, WithoutAMotionBeforeSpeedAndTurnRateCount) {
  EXPECT_TRUE(possible_motion(along_x(6.0), 0.1, std::nullopt, 0.0, kBounds));
  EXPECT_FALSE(possible_motion(along_x(6.2), 0.1, std::nullopt, 0.0, kBounds));  // 6 m and 0.1 m of noise
  EXPECT_TRUE(possible_motion(yawed(1.0), 0.1, std::nullopt, 0.0, kBounds));
  EXPECT_FALSE(possible_motion(yawed(1.1), 0.1, std::nullopt, 0.0, kBounds));
}

TEST(MotionBounds, VelocityChangesByTheAcceleration) {
  // 30 m/s² · 0.1 s · 0.1 s and twice 0.1 m of noise: 0.5 m.
  EXPECT_TRUE(possible_motion(along_x(1.49), 0.1, along_x(1.0), 0.1, kBounds));
  EXPECT_FALSE(possible_motion(along_x(1.51), 0.1, along_x(1.0), 0.1, kBounds));
  EXPECT_FALSE(possible_motion(along_x(2.0), 0.1, along_x(1.0), 0.1, kBounds));   // swapped: a sweep too early
  EXPECT_FALSE(possible_motion(along_x(-1.0), 0.1, along_x(1.0), 0.1, kBounds));  // ... and too late
}

TEST(MotionBounds, GapsAndStampsOfArrivalAreAllowedFor) {
  EXPECT_TRUE(possible_motion(along_x(7.0), 0.7, along_x(1.0), 0.1, kBounds));
  // 20 m/s, stamped 70 and 130 ms apart.
  EXPECT_TRUE(possible_motion(along_x(2.0), 0.13, along_x(2.0), 0.07, kBounds));
}

TEST(MotionBounds, TheTurnRateChangesByTheAngularAcceleration) {
  // 50 rad/s² · 0.1 s · 0.1 s and twice 0.02 rad of noise: 0.54 rad.
  EXPECT_TRUE(possible_motion(yawed(0.53), 0.1, yawed(0.0), 0.1, kBounds));
  EXPECT_FALSE(possible_motion(yawed(0.55), 0.1, yawed(0.0), 0.1, kBounds));
}

TEST(MotionBounds, OfUnevenStepsTheMiddlesCount) {
  // 0.3 s after a step of 0.1 s: their middles are 0.2 s apart, 30 m/s² · 0.2 s · 0.3 s; the step before is carried on
  // three times as long, and so is its noise: 3 m ± 2.2 m.
  EXPECT_TRUE(possible_motion(along_x(5.19), 0.3, along_x(1.0), 0.1, kBounds));
  EXPECT_FALSE(possible_motion(along_x(5.21), 0.3, along_x(1.0), 0.1, kBounds));
}

TEST(MotionBounds, BeyondThreeTimesTheStepTheStampIsNoJitter) {
  // To stand still, or nearly, at once: only if the stamps are wrong and the motion per sweep is the same, ± 2.1 m.
  EXPECT_TRUE(possible_motion(along_x(-0.5), 0.29, along_x(1.0), 0.1, kBounds));
  // 4 m ± 3.5 m by the stamps.
  EXPECT_TRUE(possible_motion(along_x(0.51), 0.4, along_x(1.0), 0.1, kBounds));
  EXPECT_FALSE(possible_motion(along_x(0.49), 0.4, along_x(1.0), 0.1, kBounds));
}

TEST(MotionBounds, AVelocityChangesByTheAccelerationAndTheNoiseOfASweep) {
  const auto possible = [](double m_s, double rad_s, double dt_s) {
    return possible_change((Vector6d() << 0, rad_s, 0, m_s, 0, 0).finished(), dt_s, kBounds);
  };
  EXPECT_TRUE(possible(3.99, 5.19, 0.1));
  EXPECT_FALSE(possible(4.01, 0, 0.1));
  EXPECT_FALSE(possible(0, 5.21, 0.1));
  EXPECT_TRUE(possible(15.9, 0, 0.5)) << "with sweeps missing one takes no longer";
  EXPECT_FALSE(possible(16.1, 0, 0.5));
  EXPECT_TRUE(possible(3.49, 0, 0.05)) << "in a shorter sweep the same noise is a larger velocity";
  EXPECT_FALSE(possible(3.51, 0, 0.05));
}

}  // namespace
}  // namespace rilo
