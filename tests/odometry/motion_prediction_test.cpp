// III-B by hand: increments, their weights, the predicted pose.
#include "odometry/motion_prediction.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr std::int64_t kPeriod = 100'000'000;

StampedPose at(std::int64_t periods, double x) {
  StampedPose pose;
  pose.stamp_ns = periods * kPeriod;
  pose.T_odom_lidar.translation().x() = x;
  return pose;
}

TEST(MotionPrediction, WeightOfTheNewestIncrementGrowsWithSigma) {
  const MotionPredictionConfig config;  // three quarters at 0.5 m
  EXPECT_DOUBLE_EQ(recent_weight(0.0, config), 0.5);
  EXPECT_DOUBLE_EQ(recent_weight(0.5, config), 0.75);
  EXPECT_NEAR(recent_weight(1e9, config), 1.0, 1e-9);
}

TEST(MotionPrediction, ZeroThenOneThenTwoIncrements) {
  const MotionPredictionConfig config;
  EXPECT_EQ(predict_velocity({}, 0.5, config), Vector6d::Zero());
  EXPECT_EQ(predict_velocity({at(0, 0.0)}, 0.5, config), Vector6d::Zero());
  EXPECT_NEAR(predict_velocity({at(0, 0.0), at(1, 1.0)}, 0.5, config)[3], 10.0, 1e-9);
  // 10 m/s, then 14 m/s, weighted 1/4 and 3/4.
  EXPECT_NEAR(predict_velocity({at(0, 0.0), at(1, 1.0), at(2, 2.4)}, 0.5, config)[3], 13.0, 1e-9);
}

TEST(MotionPrediction, DroppedSweepsDoNotBendIt) {
  const MotionPredictionConfig config;
  const Trajectory past = {at(0, 0.0), at(1, 1.0), at(4, 4.0)};
  EXPECT_NEAR(predict_pose(past, 6 * kPeriod, 0.5, config).translation().x(), 6.0, 1e-9);
}

TEST(MotionPrediction, SwitchedOffItIsTheLastPose) {
  MotionPredictionConfig config;
  config.enabled = false;
  EXPECT_NEAR(predict_pose({at(0, 0.0), at(1, 1.0)}, 2 * kPeriod, 0.5, config).translation().x(), 1.0, 1e-12);
}

}  // namespace
}  // namespace rilo
