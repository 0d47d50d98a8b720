// What the motion prior learns from turns with known accelerations.
#include "odometry/turn_noise.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "odometry/motion_prior.hpp"

namespace rilo {
namespace {

constexpr double kDt = 0.1;
constexpr double kConfigured = 2.0;  // rad/s², the default

/// A sweep that observes pose and turn rate exactly, both changed by `acceleration` (rad/s²) about z during `kDt`.
IcpResult seen(double acceleration) {
  IcpResult icp;
  Vector12d change = Vector12d::Zero();
  change[2] = 0.5 * kDt * kDt * acceleration;
  change[8] = kDt * acceleration;
  icp.state = perturbed({}, change);
  icp.sweep_information = 1e12 * Matrix12d::Identity();
  return icp;
}

/// `sweeps` more, turning to and fro.
void sway(TurnNoise& noise, double acceleration, int sweeps) {
  for (int i = 0; i < sweeps; ++i) {
    noise.learn({}, 1e-12 * Matrix6d::Identity(), {kDt}, seen(i % 2 == 0 ? acceleration : -acceleration));
  }
}

double expected(const TurnNoise& noise) { return noise.expected().angular_acceleration_rad_s2; }

TEST(TurnNoise, FindsTheAccelerationOfAHand) {
  TurnNoise noise({});
  EXPECT_EQ(expected(noise), kConfigured);
  sway(noise, 6.0, 400);
  EXPECT_NEAR(expected(noise), 6.0, 0.02);
  EXPECT_EQ(noise.expected().acceleration_m_s2, MotionPriorConfig{}.acceleration_m_s2);
}

TEST(TurnNoise, TheFirstSweepsShareWithTheConfiguredValue) {
  TurnNoise noise({});
  sway(noise, 6.0, 10);
  EXPECT_NEAR(expected(noise), std::sqrt((4.0 + 36.0) / 2.0), 0.6) << "the configured value counts ten times";
}

TEST(TurnNoise, AVehicleHasTheConfiguredOne) {
  TurnNoise noise({});
  sway(noise, 0.1, 300);
  EXPECT_EQ(expected(noise), kConfigured);
}

TEST(TurnNoise, NothingIsLearntWhereNothingIsSeen) {
  TurnNoise noise({});
  sway(noise, 6.0, 200);
  const double before = expected(noise);
  for (int i = 0; i < 100; ++i) {
    noise.learn({}, 0.01 * Matrix6d::Identity(), {kDt}, IcpResult{});
  }
  EXPECT_NEAR(expected(noise), before, 1e-9);
}

TEST(TurnNoise, NoiseOfTheSweepIsNotTakenForMotion) {
  // At rest; poses scatter by their standard deviation of 0.02 rad. Taken as certain they would turn with 4 rad/s²
  // and more.
  TurnNoise noise({});
  for (int i = 0; i < 1000; ++i) {
    Vector12d off = Vector12d::Zero();
    off.head<3>().setConstant(i % 2 == 0 ? 0.02 : -0.02);
    IcpResult icp;
    icp.sweep_information.diagonal().head<3>().setConstant(1.0 / (0.02 * 0.02));
    const MotionPrior prior = motion_prior({}, 1e-4 * Matrix6d::Identity(), {kDt}, noise.expected());
    const Vector12d mean =
        (prior.information + icp.sweep_information).ldlt().solve((icp.sweep_information * off).eval());
    icp.state = perturbed({}, mean);
    noise.learn({}, 1e-4 * Matrix6d::Identity(), {kDt}, icp);
  }
  EXPECT_LT(expected(noise), 1.1 * kConfigured);
}

TEST(TurnNoise, SwitchedOffTheConfiguredOneStays) {
  for (const bool enabled : {true, false}) {
    MotionPriorConfig config;
    config.enabled = enabled;
    config.learn = !enabled;
    TurnNoise noise(config);
    sway(noise, 6.0, 100);
    EXPECT_EQ(expected(noise), kConfigured);
  }
}

/// Sways about an axis of its own, at a heading, from sweep to sweep.
double learnt_at(double dt_s, bool turned_between) {
  TurnNoise noise({});
  for (int i = 0; i < 400; ++i) {
    const double acceleration = i % 4 < 2 ? 6.0 : -6.0;
    MotionState before;
    if (turned_between && i % 2 == 1) {
      before.T_odom_lidar.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, 0.5 * M_PI));
    }
    const Eigen::Vector3d axis = before.T_odom_lidar.linear().col(0);
    Vector12d change = Vector12d::Zero();
    change.head<3>() = 0.5 * dt_s * dt_s * acceleration * axis;
    change.segment<3>(6) = dt_s * acceleration * axis;
    IcpResult icp;
    icp.state = perturbed(before, change);
    icp.sweep_information = 1e12 * Matrix12d::Identity();
    noise.learn(before, 1e-12 * Matrix6d::Identity(), {dt_s}, icp);
  }
  return expected(noise);
}

TEST(TurnNoise, TheAxesAreThoseOfTheSensor) { EXPECT_NEAR(learnt_at(kDt, true), 6.0, 0.1); }

TEST(TurnNoise, AnAccelerationIsThatWhateverTheStep) {
  // Over a longer step a random walk moves less per second: by the root of the time.
  EXPECT_NEAR(learnt_at(2.0 * kDt, false), 6.0 * std::sqrt(2.0), 0.15);
}

}  // namespace
}  // namespace rilo
