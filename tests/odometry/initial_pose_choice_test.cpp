// III-B by hand: prediction or coarse result.
#include <functional>
#include <optional>
#include <vector>

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
  EXPECT_FALSE(stage.suspicious(0.1));  // nothing is usual yet
  stage.learn(0.8, 20.0);
  EXPECT_FALSE(stage.suspicious(17.1));
  EXPECT_TRUE(stage.suspicious(16.9));
}

TEST(InitialPoseStage, TheQualityOfTheFirstSweepsOfAMapIsNotUsual) {
  InitialPoseStage stage({}, {});
  stage.learn(0.8, std::nullopt);
  EXPECT_FALSE(stage.suspicious(0.1));
  stage.learn(0.8, 20.0);  // the first that counts, in full
  EXPECT_TRUE(stage.suspicious(14.9));
}

TEST(InitialPoseStage, AScoreBelowTheAlarmBecomesUsualTenTimesMoreSlowly) {
  InitialPoseStage stage({}, {});
  stage.learn(0.8, std::nullopt);
  stage.learn(0.6, std::nullopt);  // 0.75 of it
  EXPECT_NEAR(stage.expected_score(), 0.8 - 0.2 * 0.2, 1e-12);
  stage.learn(0.5, std::nullopt);  // 0.66 of it
  EXPECT_NEAR(stage.expected_score(), 0.76 - 0.02 * 0.26, 1e-12);
}

/// A sensor at rest in the origin of a hall that one sweep has been mapped of, and a sweep of another place.
class InitialPoseInAHall : public ::testing::Test {
 protected:
  InitialPoseInAHall() {
    LocalMapConfig config;
    config.range_noise_m = 0.0;
    config.angle_noise_rad = 0.0;
    map_ = LocalMap(config);
    map_.set_scene_range(8.0);
    map_.insert(seen_from(SE3::Identity(), 0.1), SE3::Identity());
  }

  static std::vector<Eigen::Vector3f> seen_from(const SE3& T, double spacing_m) {
    SceneSampling sampling;
    sampling.spacing_m = spacing_m;
    sampling.noise_m = 0.0;
    sampling.T_world_sensor = T;
    std::vector<Eigen::Vector3f> points = make_box_room({21.3, 13.7, 6.1}, sampling);
    SE3 corner = SE3::Identity();
    corner.translation() = Eigen::Vector3d(4.0, -3.0, -1.0);
    sampling.T_world_sensor = corner.inverse() * T;
    const auto box = make_box_room({2.0, 3.0, 4.0}, sampling);
    points.insert(points.end(), box.begin(), box.end());
    return points;
  }

  /// Of a stage for which that sweep began the map.
  InitialPoseStage begun(const InitialPoseConfig& config = {}) const {
    InitialPoseStage stage(config, {});
    stage.begin({seen_from(SE3::Identity(), 0.2)}, {}, map_);
    return stage;
  }

  /// The sweep was taken at `truth`; the sensor was last in the origin.
  InitialPose choose(InitialPoseStage& stage, const SE3& truth, const SE3& predicted, bool in_doubt,
                     const Deadline& deadline = {}, const std::optional<Reach>& reach = {}) const {
    const TimedCloud source{seen_from(truth, 0.2)};
    MotionState state;
    state.T_odom_lidar = predicted;
    const SE3 previous = SE3::Identity();
    const std::function<Vector6d(const SE3&)> at_rest = [](const SE3&) { return Vector6d(Vector6d::Zero()); };
    return stage.choose({source, state, previous, at_rest, map_, false, in_doubt, reach, deadline});
  }

  LocalMap map_{LocalMapConfig{}};
};

SE3 moved(double x, double y, double yaw_rad) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, yaw_rad));
  T.translation() << x, y, 0.0;
  return T;
}

TEST_F(InitialPoseInAHall, TheFirstSweepSaysWhatToExpect) {
  InitialPoseStage stage = begun();
  EXPECT_GT(stage.expected_score(), 0.9);
  stage.learn(0.5, 20.0);
  EXPECT_EQ(stage.expected_score(), 0.5);
  stage.begin({seen_from(SE3::Identity(), 0.2)}, {}, map_);
  EXPECT_GT(stage.expected_score(), 0.9) << "another map";
  EXPECT_FALSE(stage.suspicious(0.1));
}

TEST_F(InitialPoseInAHall, APredictionThatFitsAsUsualIsTaken) {
  InitialPoseStage stage = begun();
  stage.learn(0.95, 20.0);
  const SE3 truth = moved(0.5, 0.2, 0.05);
  const InitialPose choice = choose(stage, truth, truth, false);
  EXPECT_EQ(choice.coarse_starts, 0);
  EXPECT_EQ(choice.source, InitialPoseSource::kPrediction);
  EXPECT_EQ(choice.reason, InitialPoseReason::kCoarseNotNeeded);
}

TEST_F(InitialPoseInAHall, InDoubtItIsComparedWithTheCoarseResult) {
  InitialPoseStage stage = begun();
  const SE3 truth = moved(0.5, 0.2, 0.05);
  const InitialPose choice = choose(stage, truth, truth, true);
  EXPECT_EQ(choice.coarse_starts, 1) << "what it finds fits";
  EXPECT_GT(choice.coarse_iterations, 0);
}

TEST_F(InitialPoseInAHall, APredictionThatFitsWorseThanUsualIsInDoubt) {
  InitialPoseStage stage = begun();
  stage.learn(0.95, 20.0);
  const SE3 truth = moved(0.9, 0.3, 0.1);
  const InitialPose choice = choose(stage, truth, moved(0.0, 0.0, 0.0), false);
  EXPECT_EQ(choice.source, InitialPoseSource::kCoarse);
  EXPECT_LT((choice.T_odom_lidar.inverse() * truth).translation().norm(), 0.1);
  EXPECT_LT(rotation_angle_rad(choice.T_odom_lidar.inverse() * truth), 0.02);
}

TEST_F(InitialPoseInAHall, ASensorThatHasStoppedIsFoundAtRest) {
  InitialPoseConfig config;
  config.restarts = false;
  InitialPoseStage stage = begun(config);
  const InitialPose choice = choose(stage, SE3::Identity(), moved(6.0, 4.0, 0.8), true);
  EXPECT_EQ(choice.coarse_starts, 2);
  EXPECT_EQ(choice.source, InitialPoseSource::kCoarse);
  EXPECT_LT(choice.T_odom_lidar.translation().norm(), 0.1);
}

TEST_F(InitialPoseInAHall, AnAbruptTurnIsFoundByTheSearchOnTheMap) {
  const SE3 truth = moved(1.5, -1.0, 0.55);
  InitialPoseConfig config;
  config.restarts = false;
  InitialPoseStage without = begun(config);
  EXPECT_GT(rotation_angle_rad(choose(without, truth, SE3::Identity(), true).T_odom_lidar.inverse() * truth), 0.1);
  InitialPoseStage stage = begun();
  const InitialPose choice = choose(stage, truth, SE3::Identity(), true);
  EXPECT_EQ(choice.source, InitialPoseSource::kCoarse);
  EXPECT_LT((choice.T_odom_lidar.inverse() * truth).translation().norm(), 0.1);
  EXPECT_LT(rotation_angle_rad(choice.T_odom_lidar.inverse() * truth), 0.02);
}

TEST_F(InitialPoseInAHall, AfterAGapItLiesWhereTheMotionBeforeLeads) {
  const SE3 predicted = moved(6.0, 4.0, 0.8);
  const std::optional<Reach> reach = Reach{predicted, 1.0, 0.2};
  InitialPoseStage stage = begun();
  const InitialPose elsewhere = choose(stage, SE3::Identity(), predicted, true, {}, reach);
  EXPECT_GT(elsewhere.T_odom_lidar.translation().norm(), 4.0) << "at rest the sweep would fit";
  const SE3 truth = moved(1.5, -1.0, 1.2);
  const InitialPose turned = choose(stage, truth, SE3::Identity(), true, {}, Reach{moved(3.0, 1.0, 0.0), 2.0, 0.7});
  EXPECT_LT((turned.T_odom_lidar.inverse() * truth).translation().norm(), 0.1) << "beyond the usual search";
  EXPECT_LT(rotation_angle_rad(turned.T_odom_lidar.inverse() * truth), 0.02);
}

TEST_F(InitialPoseInAHall, AfterAGapItIsAlsoSoughtFromWhereTheTurnHasFaded) {
  InitialPoseConfig config;
  config.restarts = false;
  InitialPoseStage stage = begun(config);
  const SE3 truth = moved(6.0, 4.0, 0.8);
  const InitialPose choice = choose(stage, truth, moved(6.0, 4.0, 2.4), true, {}, Reach{truth, 2.0, 0.7});
  EXPECT_EQ(choice.coarse_starts, 2);
  EXPECT_LT((choice.T_odom_lidar.inverse() * truth).translation().norm(), 0.1);
  EXPECT_LT(rotation_angle_rad(choice.T_odom_lidar.inverse() * truth), 0.02);
}

TEST_F(InitialPoseInAHall, ASearchThatRanOutOfTimeGoesOnWithTheMapInTheNextSweep) {
  const SE3 truth = moved(1.5, -1.0, 0.55);
  InitialPoseStage in_time = begun();
  const int starts = choose(in_time, truth, SE3::Identity(), true).coarse_starts;
  InitialPoseStage stage = begun();
  std::int64_t now_ns = 0;
  const Deadline::Clock clock = [&] { return now_ns++; };
  const InitialPose cut = choose(stage, truth, SE3::Identity(), true, Deadline(clock, 1));
  EXPECT_TRUE(cut.coarse_cut);
  EXPECT_EQ(cut.coarse_starts, 1);
  const InitialPose next = choose(stage, truth, SE3::Identity(), true);
  EXPECT_EQ(next.coarse_starts, starts - 1) << "not from the prediction again";
  EXPECT_LT((next.T_odom_lidar.inverse() * truth).translation().norm(), 0.1);
}

TEST_F(InitialPoseInAHall, WithoutRestartsASearchThatRanOutOfTimeBeginsAnew) {
  const SE3 truth = moved(1.5, -1.0, 0.55);
  InitialPoseConfig config;
  config.restarts = false;
  InitialPoseStage stage = begun(config);
  std::int64_t now_ns = 0;
  const Deadline::Clock clock = [&] { return now_ns++; };
  EXPECT_TRUE(choose(stage, truth, SE3::Identity(), true, Deadline(clock, 1)).coarse_cut);
  EXPECT_GT(choose(stage, truth, SE3::Identity(), true).coarse_starts, 0);
}

TEST_F(InitialPoseInAHall, WithoutTimeThePredictionIsTaken) {
  InitialPoseStage stage = begun();
  const Deadline::Clock clock = [] { return std::int64_t{1}; };
  const InitialPose choice = choose(stage, moved(1.0, 0.0, 0.0), SE3::Identity(), true, Deadline(clock, 0));
  EXPECT_EQ(choice.reason, InitialPoseReason::kNoTime);
  EXPECT_EQ(choice.coarse_starts, 0);
  EXPECT_TRUE(choice.coarse_cut);
  EXPECT_TRUE(choice.T_odom_lidar.isApprox(SE3::Identity()));
}

}  // namespace
}  // namespace rilo
