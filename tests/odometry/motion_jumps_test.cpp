// Motions that no sensor can make, claims and losses: what they leave of the motion before.
#include <gtest/gtest.h>

#include "odometry/motion_tracker.hpp"
#include "tracked_motion.hpp"

namespace rilo::test {
namespace {

TEST(MotionJumps, AJumpIsTakenWhenTwoSweepsAgreeAndGivesNoVelocity) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.weigh(at(9.0).state), MotionVerdict::kImpossible);  // six sweeps are missing
  tracker.lose(tracker.predicted(0.3), at(9.0).state.T_odom_lidar);
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(x_of(*tracker.predicted_from_claim()), 10.0, 1e-9);
  EXPECT_EQ(tracker.weigh(at(10.0).state), MotionVerdict::kJump);
  EXPECT_EQ(tracker.weigh(at(14.0).state), MotionVerdict::kImpossible);
  tracker.accept(at(10.0), MotionVerdict::kJump, false);
  EXPECT_FALSE(tracker.lost());
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(x_of(tracker.predicted(0.3)), 11.0, 1e-6);
}

TEST(MotionJumps, AnImpossibleMotionImpliesNoVelocity) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(tracker.implied_twist(at(3.2).state.T_odom_lidar)[3], 12.0, 1e-9);
  EXPECT_NEAR(tracker.implied_twist(at(9.0).state.T_odom_lidar)[3], 10.0, 1e-9);
}

TEST(MotionJumps, AJumpLeavesTheVelocityFromBefore) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), at(9.0).state.T_odom_lidar);
  tracker.advance(after(kStepNs));
  IcpResult jump = at(10.0);
  jump.state.twist[3] = 40.0;  // what the way there implies
  tracker.accept(jump, MotionVerdict::kJump, false);
  EXPECT_NEAR(tracker.trusted().twist[3], 10.0, 1e-12);
}

// Six sweeps are missing without their stamps, and the first one after them fits as usual.
TEST(MotionJumps, AJumpAtOnceLeavesTheMotionFromBeforeToo) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  IcpResult jump = at(9.0);
  jump.state.twist[3] = 70.0;
  EXPECT_NEAR(tracker.accept(jump, MotionVerdict::kJump, false).x(), 7.0, 1e-12);
  EXPECT_NEAR(tracker.trusted().twist[3], 10.0, 1e-12);
  tracker.advance(after(kStepNs));
  EXPECT_NEAR(x_of(tracker.predicted(0.3)), 10.0, 1e-6);
  EXPECT_EQ(tracker.weigh(at(10.0).state), MotionVerdict::kPossible);
  EXPECT_EQ(tracker.weigh(at(16.0).state), MotionVerdict::kImpossible);
}

// The sweep after a claim fits as usual elsewhere: the claim was wrong, and the way from it is no motion.
TEST(MotionJumps, AJumpThatContradictsTheClaimLeavesTheStepFromBefore) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), at(50.0).state.T_odom_lidar);
  tracker.advance(after(kStepNs));
  ASSERT_EQ(tracker.weigh(at(20.0).state), MotionVerdict::kImpossible);
  tracker.accept(at(20.0), MotionVerdict::kJump, false);
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.weigh(at(21.0).state), MotionVerdict::kPossible);
}

TEST(MotionJumps, TwoClaimsInARowMayMoveOtherwiseThanBefore) {
  MotionTracker tracker = driving();
  const auto claimed = [&](double x) {
    tracker.advance(after(kStepNs));
    tracker.lose(tracker.predicted(0.3), at(x).state.T_odom_lidar);
  };
  claimed(50.0);
  claimed(54.0);
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.weigh(at(58.0).state), MotionVerdict::kJump) << "40 m/s as from claim to claim";
  EXPECT_EQ(tracker.weigh(at(55.0).state), MotionVerdict::kJump) << "10 m/s as before the loss";
  EXPECT_EQ(tracker.weigh(at(56.5).state), MotionVerdict::kImpossible);
}

TEST(MotionJumps, AClaimIsForTheNextSweepAlone) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), at(9.0).state.T_odom_lidar);
  MotionTracker accepted = tracker;
  tracker.advance(after(kStepNs));
  ASSERT_TRUE(tracker.predicted_from_claim());
  tracker.lose(tracker.predicted(0.3), std::nullopt);
  EXPECT_FALSE(tracker.predicted_from_claim());
  accepted.advance(after(kStepNs));
  accepted.accept(at(4.0), MotionVerdict::kPossible, false);
  EXPECT_FALSE(accepted.predicted_from_claim());
}

TEST(MotionJumps, AfterAJumpTheStepIsThatFromClaimToClaim) {
  MotionTracker tracker = driving();
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), at(50.0).state.T_odom_lidar);
  tracker.advance(after(kStepNs));
  tracker.lose(tracker.predicted(0.3), at(54.0).state.T_odom_lidar);
  tracker.advance(after(kStepNs));
  tracker.accept(at(58.0), MotionVerdict::kJump, false);
  tracker.advance(after(kStepNs));
  EXPECT_EQ(tracker.weigh(at(62.0).state), MotionVerdict::kPossible);
  EXPECT_EQ(tracker.weigh(at(59.0).state), MotionVerdict::kImpossible);
}

TEST(MotionJumps, AfterALongLossTheMotionBeforeIsNoEvidence) {
  const auto next_after_losses = [](int losses) {
    MotionTracker tracker = driving();
    for (int i = 0; i < losses; ++i) {
      tracker.advance(after(kStepNs));
      tracker.lose(tracker.predicted(0.3), std::nullopt);
    }
    tracker.advance(after(kStepNs));
    tracker.accept(at(3.0 + losses), MotionVerdict::kPossible, false);
    tracker.advance(after(kStepNs));
    return tracker.weigh(at(8.0 + losses).state);  // 5 m on, at 50 m/s
  };
  EXPECT_EQ(next_after_losses(1), MotionVerdict::kImpossible) << "it had 10 m/s";
  EXPECT_EQ(next_after_losses(4), MotionVerdict::kPossible);
}

}  // namespace
}  // namespace rilo::test
