// Late stamps and uneven sensors.
#include "odometry/stamp_trust.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "odometry/motion_prior.hpp"

namespace rilo {
namespace {

constexpr double kEvenStepS = 0.1;
constexpr double kForwardSpeed = 10.0;
const Matrix6d kVelocityKnown = 0.01 * Matrix6d::Identity();

/// How a sensor and its stamps behave.
struct Behaviour {
  double uneven_s = 0;           // standard deviation of when sweeps are taken, ...
  double late_s = 0;             // ... and of their stamps after that
  double information = 1e4;      // of a registration, 1/m²: 1 cm
  bool sees_the_way = true;      // false: nothing along the motion
  double speed = kForwardSpeed;  // m/s along x
};

/// A sweep taken `uneven_s` and stamped `deviation_s` after the tick of an even clock.
void take(StampTrust& trust, const Behaviour& behaviour, double uneven_s, double deviation_s) {
  MotionState last;
  last.twist[3] = behaviour.speed;
  const MotionState expected = expected_motion(last, kEvenStepS + trust.share() * deviation_s);
  const MotionPrior prior = motion_prior(expected, kVelocityKnown, {kEvenStepS}, {});
  const MotionPrior used = motion_prior(expected, kVelocityKnown, {kEvenStepS, trust.error_s(deviation_s)}, {});
  IcpResult icp;
  icp.sweep_information.diagonal().head<6>().setConstant(behaviour.information);
  if (!behaviour.sees_the_way) {
    icp.sweep_information(3, 3) = 0.0;
  }
  Vector12d seen = Vector12d::Zero();  // of the sweep alone, from the mean of the prior
  seen[3] = behaviour.speed * (kEvenStepS + uneven_s) - expected.T_odom_lidar.translation().x();
  icp.posterior_information = used.information + icp.sweep_information;
  icp.state = perturbed(expected, icp.posterior_information.ldlt().solve(icp.sweep_information * seen));
  trust.learn(deviation_s, prior, icp);
}

void learn(StampTrust& trust, const Behaviour& behaviour, int sweeps, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i < sweeps; ++i) {
    const double uneven_s = behaviour.uneven_s * normal(rng);
    take(trust, behaviour, uneven_s, uneven_s + behaviour.late_s * normal(rng));
  }
}

TEST(StampTrust, StampsAreBelievedAtFirst) {
  const StampTrust trust;
  EXPECT_EQ(trust.share(), 1.0);
  EXPECT_EQ(trust.error_s(0.004), 0.004);
  EXPECT_EQ(trust.error_s(0.0), 0.0);
}

TEST(StampTrust, LateStampsAreNot) {
  StampTrust trust;
  learn(trust, {.late_s = 0.01}, 30);
  EXPECT_LT(trust.share(), 0.1);
  EXPECT_LT(trust.error_s(0.01), 0.005);
}

TEST(StampTrust, AnUnevenSensorIs) {
  StampTrust trust;
  learn(trust, {.uneven_s = 0.01}, 30);
  EXPECT_GT(trust.share(), 0.9);
  EXPECT_LT(trust.error_s(0.01), 0.004);
}

TEST(StampTrust, OfBothTheShareOfTheMeanSquares) {
  StampTrust trust;
  learn(trust, {.uneven_s = 0.01, .late_s = 0.01}, 400);
  EXPECT_NEAR(trust.share(), 0.5, 0.15);
  EXPECT_NEAR(trust.error_s(0.0), 0.01 / std::sqrt(2.0), 0.001) << "what the deviation cannot tell";
}

TEST(StampTrust, AClockThatGetsBetterIsBelievedAgain) {
  StampTrust trust;
  learn(trust, {.late_s = 0.01}, 500);
  learn(trust, {.uneven_s = 0.01}, 60);
  EXPECT_GT(trust.share(), 0.8);
}

TEST(StampTrust, NothingIsLearntWhereNothingShows) {
  for (const Behaviour& behaviour : {Behaviour{.late_s = 0.01, .sees_the_way = false},
                                     Behaviour{.late_s = 0.01, .speed = 0.0}, Behaviour{.late_s = 0.0}}) {
    StampTrust trust;
    learn(trust, behaviour, 100);
    EXPECT_NEAR(trust.share(), 1.0, 1e-6);
  }
}

TEST(StampTrust, NothingIsLearntFromASingularSystem) {
  StampTrust trust;
  learn(trust, {.late_s = 0.01}, 30);
  const double before = trust.share();
  IcpResult icp;
  icp.sweep_information.setConstant(std::nan(""));
  icp.posterior_information = icp.sweep_information;
  MotionState moving;
  moving.twist[3] = kForwardSpeed;
  trust.learn(0.01, motion_prior(moving, kVelocityKnown, {kEvenStepS}, {}), icp);
  EXPECT_EQ(trust.share(), before);
}

TEST(StampTrust, WithoutAPriorStampsAreBelieved) {
  StampTrust trust;
  IcpResult icp;
  icp.sweep_information.setIdentity();
  icp.posterior_information.setIdentity();
  icp.state.T_odom_lidar.translation().x() = 1.0;
  trust.learn(0.01, {}, icp);
  EXPECT_EQ(trust.share(), 1.0);
}

TEST(StampTrust, WhatRunsAgainstTheStampsCountsAsMuchAsWhatFollowsThem) {
  StampTrust trust;
  for (int i = 0; i < 20; ++i) {
    const double late_s = i % 2 == 0 ? 0.01 : -0.01;
    take(trust, {}, -late_s, late_s);
  }
  EXPECT_EQ(trust.share(), 0.0) << "never less than nothing";
  for (int i = 0; i < 30; ++i) {
    const double late_s = i % 2 == 0 ? 0.01 : -0.01;
    take(trust, {}, late_s, late_s);
  }
  EXPECT_NEAR(trust.share(), (30.0 - 20.0) / 50.0, 0.1);
}

}  // namespace
}  // namespace rilo
