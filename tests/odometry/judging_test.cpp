// What is vouched for and what is not, by what is known of one sweep.
#include <gtest/gtest.h>

#include "odometry/health.hpp"
#include "odometry/sweep_map.hpp"

namespace rilo {
namespace {

IcpResult registered(IcpTermination termination = IcpTermination::kConverged) {
  IcpResult icp;
  icp.termination = termination;
  icp.iterations = 5;
  icp.degeneracy.relative_eigenvalues.setConstant(1.0);
  return icp;
}

Evidence evidence(double score) {
  Evidence e;
  e.score = score;
  e.usual_score = 0.8;
  e.map_sweeps = kEstablishedSweeps;
  return e;
}

OdometryStatus judge(const IcpResult& icp, const Evidence& e, const HealthConfig& config) {
  return status_of(loss_cause(icp, e, config), icp, e, config);
}

const HealthConfig kHealth;  // half of the usual score, in a young map never below 0.1

TEST(Judging, TheScoreMustBeNearTheUsualOne) {
  Evidence e = evidence(0.41);
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
  e.was_lost = true;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kRecovered);
  EXPECT_EQ(judge(registered(), evidence(0.39), kHealth), OdometryStatus::kLost);
}

TEST(Judging, TheFloorDoesNotDependOnWhatWasLearnt) {
  Evidence e = evidence(0.081);  // the best of seven wrong second sweeps in snow
  e.map_sweeps = kEstablishedSweeps - 1;
  e.usual_score = 0.081;  // learnt from sweeps as bad as this
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  e.usual_score = 0;
  e.map_sweeps = 1;
  e.second_sweep = true;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  e.score = 0.121;  // the least of 808 right second sweeps without snow: among bushes few points have planes
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
}

TEST(Judging, AYoungMapMustExplainFlakesToo) {
  Evidence e = evidence(0.4);  // what is left of a sweep in a snowstorm: rings on the road, which move along
  e.map_sweeps = 1;
  e.usual_score = 0;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
  e.kept_share = 0.1;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  e.kept_share = 0.3;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
  e.kept_share = 0.1;
  e.map_sweeps = kEstablishedSweeps;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
}

TEST(Judging, TheFloorIsForMapsThatMayBeWrongThemselves) {
  Evidence e = evidence(0.09);
  e.usual_score = 0.12;  // in heavy snow, with the right pose on a map that began in less of it
  for (const std::size_t few : {std::size_t{1}, kEstablishedSweeps - 1}) {
    e.map_sweeps = few;
    EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost) << few;
  }
  e.map_sweeps = kEstablishedSweeps;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
  e.score = 0.05;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
}

TEST(Judging, OneIterationIsNoFailureAndASingularSystemIs) {
  IcpResult icp = registered(IcpTermination::kIterationLimit);
  icp.iterations = 1;
  EXPECT_EQ(judge(icp, evidence(0.8), kHealth), OdometryStatus::kOk);
  EXPECT_EQ(judge(registered(IcpTermination::kSingular), evidence(0.8), kHealth), OdometryStatus::kLost);
}

TEST(Judging, ASweepThatDoesNotConvergeWithHeldMatchesIsLost) {
  IcpResult icp = registered(IcpTermination::kIterationLimit);
  icp.frozen = true;
  EXPECT_EQ(judge(icp, evidence(0.8), kHealth), OdometryStatus::kLost);
  EXPECT_EQ(loss_cause(icp, evidence(0.8), kHealth), LossCause::kNotConverged);
  icp.termination = IcpTermination::kConverged;
  EXPECT_EQ(judge(icp, evidence(0.8), kHealth), OdometryStatus::kOk);
}

TEST(Judging, ASecondSweepMustConvergeFreely) {
  IcpResult icp = registered();
  icp.frozen = true;
  Evidence e = evidence(0.8);
  EXPECT_EQ(judge(icp, e, kHealth), OdometryStatus::kOk);
  e.second_sweep = true;
  EXPECT_EQ(judge(icp, e, kHealth), OdometryStatus::kLost);
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kOk);
}

TEST(Judging, ASecondSweepMustConstrainAllDirections) {
  IcpResult icp = registered();
  icp.degeneracy.relative_eigenvalues[0] = 0.5 * kHealth.degenerate_ratio;
  Evidence e = evidence(0.8);
  EXPECT_EQ(judge(icp, e, kHealth), OdometryStatus::kDegenerate);
  e.second_sweep = true;
  EXPECT_EQ(judge(icp, e, kHealth), OdometryStatus::kLost);
}

TEST(Judging, ASweepThatMayLieElsewhereIsLost) {
  Evidence e = evidence(0.8);
  e.misplaced = LossCause::kAmbiguous;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  EXPECT_EQ(loss_cause(registered(), e, kHealth), LossCause::kAmbiguous);
}

TEST(Judging, ImpossibleMotionAndACoveredSensorAreLost) {
  Evidence e = evidence(0.8);
  e.possible_motion = false;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  EXPECT_EQ(loss_cause(registered(), e, kHealth),
            LossCause::kImpossibleMotion);  // a claim that the next sweep may confirm
  e = evidence(0.8);
  e.covered = true;
  EXPECT_EQ(judge(registered(), e, kHealth), OdometryStatus::kLost);
  EXPECT_EQ(loss_cause(registered(), e, kHealth), LossCause::kCovered);
}

TEST(Judging, OfSeveralCausesTheFirstIsSaid) {
  IcpResult icp = registered();
  EXPECT_EQ(loss_cause(icp, evidence(0.8), kHealth), LossCause::kNone);
  Evidence e = evidence(0.1);
  e.possible_motion = false;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kLowScore);
  e.second_sweep = true;
  icp.frozen = true;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kWeakSecondSweep);
  e.misplaced = LossCause::kFitsBeside;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kFitsBeside);
  e.cut_off = true;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kOutOfTime);
  icp.termination = IcpTermination::kSingular;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kUnsolved);
  e.covered = true;
  EXPECT_EQ(loss_cause(icp, e, kHealth), LossCause::kCovered);
}

TEST(Judging, DegeneracyIsSaid) {
  IcpResult icp = registered();
  icp.degeneracy.relative_eigenvalues[0] = 0.001;
  EXPECT_EQ(judge(icp, evidence(0.8), kHealth), OdometryStatus::kDegenerate);
}

}  // namespace
}  // namespace rilo
