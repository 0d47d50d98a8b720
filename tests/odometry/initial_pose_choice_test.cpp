// III-B by hand: prediction or coarse result.
#include <optional>

#include <gtest/gtest.h>

#include "odometry/initial_pose.hpp"

namespace rilo {
namespace {

ScoredPose scored(double x, double score) {
  ScoredPose pose;
  pose.T_odom_lidar.translation().x() = x;
  pose.score = score;
  return pose;
}

TEST(InitialPoseChoice, ThePapersRuleTakesTheCoarseResultWithinTau) {
  InitialPoseConfig config;
  config.rule = InitialPoseRule::kFixedTau;  // 1.5 m
  const InitialPose within = select_initial_pose(scored(0.0, 0.9), scored(1.5, 0.1), config);
  EXPECT_EQ(within.source, InitialPoseSource::kCoarse);
  EXPECT_EQ(within.reason, InitialPoseReason::kWithinTau);
  EXPECT_DOUBLE_EQ(within.pred_align_distance_m, 1.5);
  const InitialPose beyond = select_initial_pose(scored(0.0, 0.1), scored(1.6, 0.9), config);
  EXPECT_EQ(beyond.source, InitialPoseSource::kPrediction);
  EXPECT_DOUBLE_EQ(beyond.T_odom_lidar.translation().x(), 0.0);
}

TEST(InitialPoseChoice, TheMapScoreMustBeatThePredictionByTheMargin) {
  const InitialPoseConfig config;  // 0.03 of the prediction's
  EXPECT_EQ(select_initial_pose(scored(0.0, 0.50), scored(9.0, 0.53), config).source, InitialPoseSource::kCoarse);
  EXPECT_EQ(select_initial_pose(scored(0.0, 0.50), scored(9.0, 0.51), config).source, InitialPoseSource::kPrediction);
}

TEST(InitialPoseStage, AFitFarBelowTheUsualOneIsSuspicious) {
  InitialPoseStage stage({}, {});
  EXPECT_FALSE(stage.suspicious(0.1));  // nothing is usual yet
  stage.learn(0.8, 20.0);
  EXPECT_FALSE(stage.suspicious(15.1));
  EXPECT_TRUE(stage.suspicious(14.9));
}

TEST(InitialPoseStage, TheQualityOfTheFirstSweepsOfAMapIsNotUsual) {
  InitialPoseStage stage({}, {});
  stage.learn(0.8, std::nullopt);
  EXPECT_FALSE(stage.suspicious(0.1));
  stage.learn(0.8, 20.0);  // the first that counts, in full
  EXPECT_TRUE(stage.suspicious(14.9));
}

}  // namespace
}  // namespace rilo
