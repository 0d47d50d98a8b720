// III-B by hand: prediction or coarse result.
#include <optional>

#include <gtest/gtest.h>

#include "odometry/initial_pose.hpp"
#include "simulation/test_scenes.hpp"

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
  EXPECT_FALSE(stage.suspicious(0.1, 0.5));  // nothing is usual yet
  stage.learn(0.8, 0.03);
  // Score over residuals below 0.8 of the usual.
  EXPECT_FALSE(stage.suspicious(0.66, 0.03));
  EXPECT_TRUE(stage.suspicious(0.62, 0.03));
  EXPECT_FALSE(stage.suspicious(0.8, 0.036));
  EXPECT_TRUE(stage.suspicious(0.8, 0.039));
}

TEST(InitialPoseStage, ResidualsOfTheFirstSweepsOfAMapAreNotUsual) {
  InitialPoseStage stage({}, {});
  stage.learn(0.8, std::nullopt);
  EXPECT_FALSE(stage.suspicious(0.1, 0.5));
  stage.learn(0.8, 0.03);  // the first that counts, in full
  EXPECT_FALSE(stage.suspicious(0.8, 0.036));
  EXPECT_TRUE(stage.suspicious(0.8, 0.039));
}

TEST(InitialPoseStage, ASweepIsFoundWhereItLiesOnThePath) {
  SceneSampling sampling;
  sampling.spacing_m = 0.1;
  LocalMap map({});
  map.insert(make_box_room({30.0, 8.0, 4.0}, sampling), SE3::Identity());
  sampling.seed = 2;
  sampling.spacing_m = 0.2;
  sampling.T_world_sensor.translation().x() = 6.0;
  const TimedCloud source{make_box_room({30.0, 8.0, 4.0}, sampling), {}};
  MotionState predicted;  // at 1 m and 10 m/s: five periods of 0.1 s late
  predicted.T_odom_lidar.translation().x() = 1.0;
  predicted.twist[3] = 10.0;
  InitialPoseStage stage({}, {});
  const std::vector<SE3> places = stage.places_on_path(source, predicted, 0.1, map);
  ASSERT_FALSE(places.empty());
  EXPECT_NEAR(places.front().translation().x(), 6.0, 0.15);  // half a step
  EXPECT_LE(places.size(), 3U);
  predicted.T_odom_lidar.translation().x() = 12.0;  // six periods early: a piece of the path came in reversed order
  const std::vector<SE3> behind = stage.places_on_path(source, predicted, 0.1, map);
  ASSERT_FALSE(behind.empty());
  EXPECT_NEAR(behind.front().translation().x(), 6.0, 0.15);
}

}  // namespace
}  // namespace rilo
