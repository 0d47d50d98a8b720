// What is vouched for in the light of the sweeps before, and when a map is given up.
#include "odometry/sweep_judge.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

const HealthConfig kJudgeConfig;

/// A sweep of a place of this size (m).
PreparedSweep sweep_of(double range_m) {
  PreparedSweep prepared;
  prepared.source.points.resize(1000, Eigen::Vector3f::UnitX());
  prepared.median_range_m = range_m;
  return prepared;
}

Registration fitting() {
  Registration registration;
  registration.icp.termination = IcpTermination::kConverged;
  registration.icp.degeneracy.relative_eigenvalues.setConstant(1.0);
  registration.score = 0.8;
  return registration;
}

TEST(SweepJudge, ARegistrationCutOffFarFromItsEndIsLost) {
  const SweepJudge judge(kJudgeConfig);
  Registration registration = fitting();
  const auto status_after = [&](double turn_rad, double shift_m) {
    registration.icp.last_update << 0.0, 0.0, turn_rad, shift_m, 0.0, 0.0;
    return judge.judge(sweep_of(10.0), registration, MotionVerdict::kPossible, {10, 0.8, 0.0, false}).status;
  };
  registration.icp.termination = IcpTermination::kTimeLimit;
  EXPECT_EQ(status_after(0.005, 0.03), OdometryStatus::kOk);
  EXPECT_EQ(status_after(0.0, 0.11), OdometryStatus::kLost);
  EXPECT_EQ(status_after(0.011, 0.0), OdometryStatus::kLost) << "11 cm at the range of the points";
  registration.icp.termination = IcpTermination::kConverged;
  EXPECT_EQ(status_after(0.0, 0.11), OdometryStatus::kOk);
}

TEST(SweepJudge, APlaceOfLessThanAThirdOfTheLastIsACover) {
  SweepJudge judge(kJudgeConfig);
  judge.begin(sweep_of(60.0), false);
  judge.accept(sweep_of(30.0), fitting(), false);
  const auto at = [&](double range_m) {
    return judge.judge(sweep_of(range_m), fitting(), MotionVerdict::kPossible, {10, 0.8, 0.0, false});
  };
  EXPECT_EQ(at(10.1).status, OdometryStatus::kOk);
  EXPECT_EQ(at(9.9).status, OdometryStatus::kLost);
  EXPECT_EQ(at(9.9).cause, LossCause::kCovered);
  EXPECT_FALSE(at(9.9).fits_map());
  judge.accept(sweep_of(15.0), fitting(), false);
  EXPECT_EQ(at(9.9).status, OdometryStatus::kOk);
}

// Two neighbouring sweeps swapped: each fits the map a little worse, and what showed the way forward has no match.
TEST(SweepJudge, ASweepThatSuddenlySeesADirectionMuchLessDoesNotBelongThere) {
  SweepJudge judge(kJudgeConfig);
  judge.begin(sweep_of(10.0), false);
  Registration usual = fitting();
  usual.quality = 20.0;
  usual.icp.degeneracy.relative_eigenvalues[0] = 0.05;
  for (int i = 0; i < 10; ++i) judge.accept(sweep_of(10.0), usual, false);
  const auto status = [&](double quality, double eigenvalue, bool was_lost = false) {
    Registration registration = usual;
    registration.quality = quality;
    registration.icp.degeneracy.relative_eigenvalues[0] = eigenvalue;
    return judge.judge(sweep_of(10.0), registration, MotionVerdict::kPossible, {10, 0.8, 20.0, was_lost}).status;
  };
  EXPECT_EQ(status(17.0, 0.012), OdometryStatus::kLost);
  EXPECT_EQ(status(17.0, 0.013), OdometryStatus::kOk);
  EXPECT_EQ(status(18.1, 0.012), OdometryStatus::kOk) << "a place may show a direction less, when it fits";
  EXPECT_EQ(status(17.0, 0.004), OdometryStatus::kDegenerate) << "a tunnel begins";
  EXPECT_EQ(status(17.0, 0.012, true), OdometryStatus::kRecovered) << "a place that has changed is taken as it is";
  judge.begin(sweep_of(10.0), false);
  EXPECT_EQ(status(17.0, 0.012), OdometryStatus::kOk) << "of a new map nothing is usual";
  Registration less = usual;
  less.icp.degeneracy.relative_eigenvalues[0] = 0.02;
  judge.accept(sweep_of(10.0), usual, false);
  judge.accept(sweep_of(10.0), less, false);
  EXPECT_EQ(status(17.0, 0.0109), OdometryStatus::kLost) << "0.044 is usual: a fifth of the change counts";
  EXPECT_EQ(status(17.0, 0.0111), OdometryStatus::kOk);
}

// An open field: the drift along a direction that was not seen is in the map, and sweeps fit that, too.
TEST(SweepJudge, WhereADirectionWasNotSeenForLongItMustBeSeenMoreClearly) {
  SweepJudge judge(kJudgeConfig);
  judge.begin(sweep_of(10.0), false);
  const auto status = [&](double ratio) {
    Registration registration = fitting();
    registration.icp.degeneracy.relative_eigenvalues[0] = ratio * kJudgeConfig.degenerate_ratio;
    return judge.judge(sweep_of(10.0), registration, MotionVerdict::kPossible, {10, 0.8, 0.0, false}).status;
  };
  EXPECT_EQ(status(1.01), OdometryStatus::kOk);
  judge.accept(sweep_of(10.0), fitting(), true);
  EXPECT_EQ(status(1.04), OdometryStatus::kDegenerate) << "a sweep counts for a twentieth";
  EXPECT_EQ(status(1.06), OdometryStatus::kOk);
  for (int i = 0; i < 100; ++i) judge.accept(sweep_of(10.0), fitting(), true);
  EXPECT_EQ(status(1.98), OdometryStatus::kDegenerate);
  EXPECT_EQ(status(2.01), OdometryStatus::kOk);
  for (int i = 0; i < 14; ++i) judge.accept(sweep_of(10.0), fitting(), false);
  EXPECT_EQ(status(1.5), OdometryStatus::kOk) << "half of it is forgotten";
  judge.accept(sweep_of(10.0), fitting(), true);
  judge.begin(sweep_of(10.0), false);
  EXPECT_EQ(status(1.01), OdometryStatus::kOk) << "a new map";
}

// A handheld sweep after some in reverse order, 4.5° off: it shows every direction, and lies beside the map.
TEST(SweepJudge, ASweepThatFitsAThirdAsWellAsUsualDoesNotBelongThere) {
  const SweepJudge judge(kJudgeConfig);
  const auto status = [&](double quality, double eigenvalue, bool was_lost = false) {
    Registration registration = fitting();
    registration.quality = quality;
    registration.icp.degeneracy.relative_eigenvalues[0] = eigenvalue;
    return judge.judge(sweep_of(10.0), registration, MotionVerdict::kPossible, {10, 0.8, 30.0, was_lost}).status;
  };
  EXPECT_EQ(status(10.1, 0.5), OdometryStatus::kOk);
  EXPECT_EQ(status(9.9, 0.5), OdometryStatus::kLost);
  EXPECT_EQ(status(9.9, 0.004), OdometryStatus::kDegenerate);
  EXPECT_EQ(status(9.9, 0.5, true), OdometryStatus::kRecovered);
}

// In a map of many places every sweep finds a pose that fits.
TEST(SweepJudge, ASweepThatPlacesBesideExplainAsWellIsLost) {
  const SweepJudge judge(kJudgeConfig);
  Registration registration = fitting();
  const auto status = [&](bool was_lost) {
    return judge.judge(sweep_of(10.0), registration, MotionVerdict::kPossible, {10, 0.8, 0.0, was_lost}).status;
  };
  EXPECT_EQ(status(false), OdometryStatus::kOk);
  registration.stands_out = false;
  EXPECT_EQ(status(false), OdometryStatus::kLost);
  EXPECT_EQ(status(true), OdometryStatus::kLost);
  registration.icp.degeneracy.relative_eigenvalues[0] = 0.001;
  EXPECT_EQ(status(false), OdometryStatus::kLost);
}

TEST(SweepJudge, AfterALossASweepMustFitNearlyAsUsualUnlessTwoAgreeOrItHasNotMoved) {
  const SweepJudge judge(kJudgeConfig);
  const auto status = [&](double score, bool was_lost, MotionVerdict motion = MotionVerdict::kPossible,
                          bool stayed = false) {
    Registration registration = fitting();
    registration.score = score;
    return judge.judge(sweep_of(10.0), registration, motion, {10, 0.8, 0.0, was_lost, false, stayed}).status;
  };
  EXPECT_EQ(status(0.57, true), OdometryStatus::kRecovered);
  EXPECT_EQ(status(0.55, true), OdometryStatus::kLost);
  EXPECT_EQ(status(0.55, false), OdometryStatus::kOk);
  EXPECT_EQ(status(0.41, true, MotionVerdict::kJump), OdometryStatus::kRecovered);
  EXPECT_EQ(status(0.39, true, MotionVerdict::kJump), OdometryStatus::kLost);
  // A vehicle stands, and a lorry before it drives off.
  EXPECT_EQ(status(0.41, true, MotionVerdict::kPossible, true), OdometryStatus::kRecovered);
  EXPECT_EQ(status(0.39, true, MotionVerdict::kPossible, true), OdometryStatus::kLost);
}

TEST(SweepJudge, AMotionThatIsImpossibleIsAClaim) {
  const SweepJudge judge(kJudgeConfig);
  const auto after = [&](MotionVerdict motion) {
    return judge.judge(sweep_of(10.0), fitting(), motion, {10, 0.8, 0.0, true});
  };
  EXPECT_EQ(after(MotionVerdict::kImpossible).status, OdometryStatus::kLost);
  EXPECT_EQ(after(MotionVerdict::kImpossible).cause, LossCause::kImpossibleMotion);
  EXPECT_TRUE(after(MotionVerdict::kImpossible).fits_map());
  EXPECT_EQ(after(MotionVerdict::kJump).status, OdometryStatus::kRecovered);
}

// Sweeps are missing, or come at uneven times: what a sweep says is more certain than when it was taken.
TEST(SweepJudge, AMotionThatIsImpossibleIsAJumpWhereTheSweepFitsAsUsual) {
  const SweepJudge judge(kJudgeConfig);
  const auto verdict = [&](const Registration& registration, double usual_quality = 20.0) {
    const Judgement judgement =
        judge.judge(sweep_of(10.0), registration, MotionVerdict::kImpossible, {10, 0.8, usual_quality, false});
    EXPECT_EQ(judgement.status == OdometryStatus::kOk, judgement.motion == MotionVerdict::kJump);
    return judgement.motion;
  };
  Registration registration = fitting();
  registration.quality = 17.1;
  EXPECT_EQ(verdict(registration), MotionVerdict::kJump);
  EXPECT_EQ(verdict(registration, 0.0), MotionVerdict::kImpossible) << "nothing is usual yet";
  registration.icp.frozen = true;
  EXPECT_EQ(verdict(registration), MotionVerdict::kImpossible) << "its matches had to be held";
  registration.icp.frozen = false;
  registration.icp.degeneracy.relative_eigenvalues[0] = 0.004;
  EXPECT_EQ(verdict(registration), MotionVerdict::kImpossible) << "one direction is open";
  registration.icp.degeneracy.relative_eigenvalues[0] = 1.0;
  registration.quality = 16.9;
  EXPECT_EQ(verdict(registration), MotionVerdict::kImpossible);
}

TEST(SweepJudge, AnEstablishedMapIsGivenUpAfterTenLossesInARow) {
  SweepJudge judge(kJudgeConfig);
  EXPECT_TRUE(judge.give_up(false, 1.0, LossCause::kLowScore)) << "a young map may be the wrong one";
  judge.begin(sweep_of(10.0), false);
  for (int round = 0; round < 2; ++round) {
    for (int lost = 1; lost < kJudgeConfig.restart_after; ++lost) {
      EXPECT_FALSE(judge.give_up(true, lost, LossCause::kLowScore)) << lost;
    }
    judge.accept(sweep_of(10.0), fitting(), false);
  }
  for (int lost = 1; lost < kJudgeConfig.restart_after; ++lost) {
    judge.give_up(true, lost, LossCause::kLowScore);
  }
  EXPECT_TRUE(judge.give_up(true, kJudgeConfig.restart_after, LossCause::kLowScore));
}

// A hand on the sensor for longer than a map is kept.
TEST(SweepJudge, WhatCoversASensorMovesAlongWithIt) {
  SweepJudge judge(kJudgeConfig);
  judge.begin(sweep_of(1.0), true);
  JudgedAgainst before{1, 0.0, 0.0, false, false, true};
  const auto verdict = [&] { return judge.judge(sweep_of(1.0), fitting(), MotionVerdict::kPossible, before); };
  EXPECT_EQ(verdict().status, OdometryStatus::kLost);
  EXPECT_EQ(verdict().cause, LossCause::kCovered);
  judge.begin(sweep_of(1.1), false);
  EXPECT_EQ(verdict().cause, LossCause::kCovered) << "whatever the second sweep was lost for";
  before.stayed = false;
  EXPECT_EQ(verdict().status, OdometryStatus::kOk) << "a narrow place that the sensor moves through";
  judge.accept(sweep_of(1.0), fitting(), false);
  before = {2, 0.8, 0.0, false, false, true};
  EXPECT_EQ(verdict().status, OdometryStatus::kOk) << "it may stop there";
  before = {1, 0.0, 0.0, false, false, true};
  judge.begin(sweep_of(1.0), false);
  EXPECT_EQ(verdict().status, OdometryStatus::kOk) << "it may begin there, at rest";
}

TEST(SweepJudge, ASensorThatStaysCoveredIsSomewhereElse) {
  SweepJudge judge(kJudgeConfig);
  judge.begin(sweep_of(10.0), false);
  for (int lost = 1; lost < kJudgeConfig.restart_after; ++lost) {
    EXPECT_FALSE(judge.give_up(true, lost, LossCause::kCovered)) << lost;
  }
  EXPECT_TRUE(judge.give_up(true, kJudgeConfig.restart_after, LossCause::kCovered));
}

TEST(SweepJudge, AfterTenBeginningsInARowASecondSweepMayLeaveADirectionOpen) {
  SweepJudge judge(kJudgeConfig);
  Registration along_a_road = fitting();
  along_a_road.icp.degeneracy.relative_eigenvalues[0] = 0.5 * kJudgeConfig.degenerate_ratio;
  const auto second = [&] {
    return judge.judge(sweep_of(10.0), along_a_road, MotionVerdict::kPossible, {1, 0.8, 0.0, false}).status;
  };
  for (int i = 0; i < 10; ++i) {
    judge.begin(sweep_of(10.0), false);
    EXPECT_EQ(second(), OdometryStatus::kLost) << i;
  }
  judge.begin(sweep_of(10.0), false);
  EXPECT_EQ(second(), OdometryStatus::kDegenerate);
  judge.accept(sweep_of(10.0), fitting(), false);
  judge.begin(sweep_of(10.0), false);
  EXPECT_EQ(second(), OdometryStatus::kLost) << "no longer in a row";
}

}  // namespace
}  // namespace rilo
