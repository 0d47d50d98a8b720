// What enters the motion and what does not.
#include "odometry/motion_tracker.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tracked_motion.hpp"

namespace rilo::test {
namespace {

TEST(MotionTracker, LostPosesDoNotEnterThePrediction) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), std::nullopt);
  EXPECT_TRUE(tracker.lost());
  EXPECT_NEAR(x_of(tracker.state()), 3.0, 1e-9);
  EXPECT_NEAR(x_of(tracker.trusted()), 2.0, 1e-9);
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(x_of(tracker.predicted(0.3)), 4.0, 1e-9);
}

TEST(MotionTracker, ASensorHasStayedWhereTheLastTrustedPoseIsFoundAgain) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), std::nullopt);
  EXPECT_TRUE(tracker.stayed(at(2.09).state.T_odom_lidar));
  EXPECT_FALSE(tracker.stayed(at(2.11).state.T_odom_lidar));
  EXPECT_FALSE(tracker.stayed(at(3.0).state.T_odom_lidar)) << "the guess for the lost one is none";
  SE3 turned = at(2.0).state.T_odom_lidar;
  turned.linear() = so3_exp(Eigen::Vector3d(0, 0, 0.019));
  EXPECT_TRUE(tracker.stayed(turned));
  turned.linear() = so3_exp(Eigen::Vector3d(0, 0, 0.021));
  EXPECT_FALSE(tracker.stayed(turned));
}

TEST(MotionTracker, ASweepAcceleratesFromTheOneBefore) {
  MotionTracker tracker({}, {}, {});
  tracker.begin({});
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.predicted(0.3).earlier.lag_s, 0.0) << "the first velocity of a map is a guess";
  tracker.accept(at(1.0), MotionVerdict::kPossible, false);
  tracker.advance(after(2 * kStepNs));
  MotionState state = tracker.predicted(0.3);
  EXPECT_EQ(state.motion().acceleration, Vector6d(Vector6d::Zero())) << "as predicted";
  state.twist[3] += 3.0;
  EXPECT_NEAR(state.motion().acceleration[3], 15.0, 1e-9);
  tracker.lose(state, std::nullopt);
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.predicted(0.3).earlier.lag_s, 0.0) << "lost";
}

/// A step after a second sweep that has sped up.
MotionTracker sped_up(bool degenerate) {
  MotionTracker tracker({}, {}, {});
  tracker.begin({});
  tracker.advance(after(kStepNs));
  tracker.accept(at(1.0), MotionVerdict::kPossible, false);
  tracker.advance(after(kStepNs));
  IcpResult second = at(2.0);
  second.state.earlier = tracker.predicted(0.3).earlier;
  second.state.twist[3] += 1.0;  // 10 m/s²
  tracker.accept(second, MotionVerdict::kPossible, degenerate);
  tracker.advance(after(kStepNs));
  return tracker;
}

TEST(MotionTracker, AQuarterOfTheChangeOfTheAccelerationGoesOn) {
  MotionTracker tracker = sped_up(false);
  MotionState state = tracker.predicted(0.3);
  state.twist[3] += 2.0;  // 20 m/s²
  EXPECT_NEAR(state.motion().acceleration[3], 22.5, 1e-9);
  tracker.advance(after(2 * kStepNs));  // three steps after the second sweep
  state = tracker.predicted(0.3);
  state.twist[3] += 2.0;
  EXPECT_NEAR(state.motion().acceleration[3], 20.0 / 3 + 0.375 * (20.0 / 3 - 10.0), 1e-9);
}

TEST(MotionTracker, AStampThatMayBeLateRefutesNoMotion) {
  const MotionState next = at(3.0).state;
  MotionTracker tracker = driving();
  tracker.advance({.step_ns = kStepNs / 10, .even_ns = kStepNs / 10});
  EXPECT_EQ(tracker.weigh(next), MotionVerdict::kImpossible) << "1 m in 10 ms";
  tracker = driving();
  tracker.advance({.step_ns = kStepNs / 10, .even_ns = kStepNs});
  EXPECT_EQ(tracker.weigh(next), MotionVerdict::kPossible);
}

// A sweep bent along a wrong velocity fits a little beside its place.
TEST(MotionTracker, AVelocityThatCannotFollowTheOneBeforeIsImpossible) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  MotionState next = at(3.0).state;
  next.twist[3] = 13.9;  // 30 m/s² for 0.1 s, and 1 m/s of noise
  EXPECT_EQ(tracker.weigh(next), MotionVerdict::kPossible);
  next.twist[3] = 14.1;
  EXPECT_EQ(tracker.weigh(next), MotionVerdict::kImpossible);
  next.twist << 0.0, 0.0, 5.3, 10.0, 0.0, 0.0;  // 50 rad/s² for 0.1 s, and 0.2 rad/s of noise
  EXPECT_EQ(tracker.weigh(next), MotionVerdict::kImpossible);
  MotionTracker begun({}, {}, {});
  begun.begin({});
  begun.advance(after(kStepNs));
  EXPECT_EQ(begun.weigh(at(1.0).state), MotionVerdict::kPossible) << "the velocity at the beginning is a guess";
}

TEST(MotionTracker, StampsThatMotionContradictsDoNotCount) {
  MotionTracker tracker = driving();
  for (int i = 0; i < 20; ++i) {
    const std::int64_t late_ns = (i % 2 == 0 ? 1 : -1) * kStepNs / 10;
    tracker.advance({.step_ns = kStepNs + late_ns, .even_ns = kStepNs});
    IcpResult icp = at(3.0 + i);
    icp.sweep_information = 1e4 * Matrix12d::Identity();
    icp.posterior_information = tracker.prior(std::nullopt).information + icp.sweep_information;
    tracker.accept(icp, MotionVerdict::kPossible, false);
  }
  tracker.advance({.step_ns = kStepNs + kStepNs / 10, .even_ns = kStepNs});
  EXPECT_NEAR(tracker.since_trusted_s(), 0.1, 0.001);
}

TEST(MotionTracker, AStampThatWasUnevenIsSettledWithItsSweep) {
  const auto information_after = [](std::int64_t late_ns) {
    MotionTracker tracker = driving();
    tracker.advance({.step_ns = kStepNs + late_ns, .even_ns = kStepNs});
    tracker.accept(at(3.0), MotionVerdict::kPossible, false);
    tracker.advance(after(kStepNs));
    return tracker.prior(std::nullopt).information;
  };
  EXPECT_TRUE(information_after(kStepNs / 10).isApprox(information_after(0), 1e-9));
}

/// Swayed about x, 0.6 rad/s to and fro from sweep to sweep; its prior's information on the turn rate.
double information_when_swayed(bool lost_between) {
  MotionTracker tracker = driving();
  for (int i = 0; i < 60; ++i) {
    tracker.advance(after(kStepNs));
    if (lost_between) {
      tracker.lose(tracker.state(), std::nullopt);
      tracker.advance(after(kStepNs));
    }
    IcpResult icp = at(2.0);
    icp.state.twist << (i % 2 == 0 ? 0.3 : -0.3), 0.0, 0.0, 0.0, 0.0, 0.0;
    icp.posterior_information *= 1e12;
    icp.sweep_information = icp.posterior_information;
    tracker.accept(icp, MotionVerdict::kPossible, false);
  }
  tracker.advance(after(kStepNs));
  return tracker.prior(MotionState{}).information(6, 6);
}

TEST(MotionTracker, LearnsHowItIsTurnedFromSweepsInARow) {
  MotionTracker untaught = driving();
  untaught.advance(after(kStepNs));
  const double configured = untaught.prior(MotionState{}).information(6, 6);
  EXPECT_LT(information_when_swayed(false), 0.9 * configured);
  EXPECT_EQ(information_when_swayed(true), configured);
}

TEST(MotionTracker, AfterALossTheVelocityIsNotKnown) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(covariance_of(tracker.prior(std::nullopt))(9, 9), 1.0 + 0.1 * 10.0, 1e-6);
  tracker.lose(tracker.predicted(0.3), std::nullopt);
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(covariance_of(tracker.prior(std::nullopt))(9, 9), 400.0 + 0.2 * 10.0, 1e-3);
  tracker.accept(at(4.0), MotionVerdict::kPossible, false);
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(covariance_of(tracker.prior(std::nullopt))(9, 9), 400.0 + 0.1 * 10.0, 1e-3) << "nor when found again";
  EXPECT_NEAR(tracker.predicted(0.3).earlier.lag_s, 0.1, 1e-9) << "but its changes count again";
}

TEST(MotionTracker, WhatADegenerateSweepDoesNotSeeKeepsItsVelocity) {
  MotionTracker tracker = sped_up(true);
  // A fifth of the configured 10 m/s², squared, over 0.1 s.
  EXPECT_NEAR(covariance_of(tracker.prior(std::nullopt))(9, 9), 1.0 + 0.1 * 0.4, 1e-9);
  MotionState state = tracker.predicted(0.3);
  state.twist[3] += 2.0;
  EXPECT_NEAR(state.motion().acceleration[3], 20.0, 1e-9) << "nothing of its change goes on";
}

TEST(MotionTracker, ThePriorOfTheSweepBeforeLooksBack) {
  MotionTracker tracker({}, {}, {});
  tracker.begin({});
  tracker.advance(after(2 * kStepNs));
  const MotionPrior prior = tracker.prior_before(at(3.0));
  EXPECT_NEAR(prior.state.T_odom_lidar.translation().x(), 1.0, 1e-12) << "10 m/s, 0.2 s ago";
  EXPECT_NEAR(prior.state.twist[3], 10.0, 1e-12);
  EXPECT_NEAR(covariance_of(prior)(3, 9), -(0.2 + 0.02 * 10.0), 1e-6);
}

TEST(MotionTracker, ANewMapBeginsWithoutWhatWas) {
  MotionTracker tracker = driving();
  tracker.advance({.step_ns = kStepNs, .even_ns = kStepNs});
  tracker.accept(at(3.0), MotionVerdict::kPossible, true);
  tracker.advance({.step_ns = kStepNs + kStepNs / 5, .even_ns = kStepNs});
  tracker.lose(tracker.predicted(0.3), at(9.0).state.T_odom_lidar);
  MotionState moving;
  moving.twist[3] = 10.0;
  tracker.begin(moving);
  tracker.advance(after(kStepNs));
  EXPECT_FALSE(tracker.lost());
  EXPECT_FALSE(tracker.degenerate());
  EXPECT_FALSE(tracker.predicted_from_claim());
  EXPECT_EQ(tracker.weigh(at(5.0).state), MotionVerdict::kPossible) << "50 m/s at once";
  MotionTracker fresh({}, {}, {});
  fresh.begin(moving);
  fresh.advance(after(kStepNs));
  EXPECT_TRUE(tracker.prior(std::nullopt).information.isApprox(fresh.prior(std::nullopt).information, 1e-12));
}

TEST(MotionTracker, AMapBeginsWithAKnownVelocityUntilASweepIsAcceptedOrItsTimeHasPassed) {
  MotionTracker tracker({}, {}, {});
  KnownVelocity known{Vector6d::Zero(), 0.25};
  known.twist[3] = 20.0;
  tracker.reset(known);
  EXPECT_EQ(tracker.begin({}).twist[3], 20.0);
  EXPECT_TRUE(tracker.begun_moving());
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(tracker.predicted(0.3).T_odom_lidar.translation().x(), 2.0, 1e-9);
  MotionState second = at(2.0).state;
  second.twist[3] = 20.0;
  EXPECT_EQ(tracker.weigh(second), MotionVerdict::kPossible);
  EXPECT_EQ(tracker.weigh(at(0.0).state), MotionVerdict::kImpossible) << "200 m/s²";
  // A random walk for 0.25 s, with a fifth of the configured 10 m/s², and as configured for the step.
  EXPECT_NEAR(covariance_of(tracker.prior(std::nullopt))(9, 9), 0.25 * 0.4 + 0.1 * 10.0, 1e-9);

  tracker.begin({});
  EXPECT_TRUE(tracker.begun_moving()) << "the next one, too";
  tracker.advance(after(2 * kStepNs));
  EXPECT_EQ(tracker.begin({}).twist[3], 0.0) << "its time has passed";
  EXPECT_FALSE(tracker.begun_moving());

  tracker.reset(known);
  tracker.begin({});
  tracker.advance(after(kStepNs));
  MotionTracker lost = tracker;
  lost.lose(lost.predicted(0.3), std::nullopt);
  EXPECT_FALSE(lost.begun_moving()) << "the velocity is unknown after a loss, that of an empty sweep, too";
  EXPECT_EQ(lost.begin({}).twist[3], 20.0) << "but the next map begins with it";
  tracker.accept(at(2.0), MotionVerdict::kPossible, false);
  EXPECT_FALSE(tracker.begun_moving());
  EXPECT_EQ(tracker.begin({}).twist[3], 0.0) << "a later map has nothing to do with it";
}

TEST(MotionTracker, ThePriorExpectsTurnsToEndAndPosesStayRotations) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  IcpResult turning = at(3.0);
  turning.state.twist[2] = 1.0;
  turning.state.T_odom_lidar.linear()(0, 0) += 1e-6;  // rounded again and again
  tracker.accept(turning, MotionVerdict::kPossible, false);
  EXPECT_TRUE(tracker.trusted().T_odom_lidar.linear().isUnitary(1e-12));
  tracker.advance(after(kStepNs));
  const MotionPrior prior = tracker.prior(std::nullopt);
  EXPECT_NEAR(prior.state.twist[2], std::exp(-0.1), 1e-9);
  EXPECT_NEAR(rotation_angle_rad(prior.state.T_odom_lidar), 0.1 * std::exp(-0.1), 1e-6);
}

}  // namespace
}  // namespace rilo::test
