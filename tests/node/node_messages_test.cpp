// What the nodes publish, without ROS.
#include "rilo/node/node_messages.hpp"

#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "node/base_frame.hpp"

namespace rilo {
namespace {

SE3 some_pose(double x, double y, double z, const Eigen::Vector3d& rotation) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(rotation);
  T.translation() << x, y, z;
  return T;
}

SweepResult some_result() {
  SweepResult result;
  result.stamp_ns = 1'700'000'000'123'456'789;
  result.T_odom_lidar = some_pose(10, -4, 1, {0.1, -0.2, 1.3});
  result.twist << 0.1, 0.2, 0.3, 4, 5, 6;
  Matrix6d root = Matrix6d::Random() * 0.01;
  root.diagonal().array() += 0.05;
  result.covariance = root * root.transpose();
  return result;
}

const SE3 kBaseLidar = some_pose(1.2, -0.3, 1.7, {0.02, -0.03, 0.4});

// Position and rotation vector about fixed axes between two poses, as geometry_msgs/PoseWithCovariance has them.
Vector6d ros_difference(const SE3& from, const SE3& to) {
  Vector6d difference;
  difference << to.translation() - from.translation(), so3_log(to.linear() * from.linear().transpose());
  return difference;
}

TEST(NodeMessages, TheCovarianceIsThatOfSmallDisturbances) {
  const SweepResult result = some_result();
  const SE3 T_world_odom = some_pose(5, 6, 7, {0, 0, -2});
  const SweepResult base = of_base(result, kBaseLidar, T_world_odom);
  // Column by column: how the base's pose moves with the LiDAR's.
  constexpr double kStep = 1e-6;
  Matrix6d jacobian;
  for (int i = 0; i < 6; ++i) {
    const SE3 disturbed = result.T_odom_lidar * se3_exp(kStep * Vector6d::Unit(i));
    jacobian.col(i) = ros_difference(base.T_odom_lidar, base_pose(disturbed, kBaseLidar, T_world_odom)) / kStep;
  }
  const Matrix6d expected = jacobian * result.covariance * jacobian.transpose();
  const OdometryMessage message = odometry_message(base, 0.1, "odom", "base_link");
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      EXPECT_NEAR(message.pose_covariance[static_cast<std::size_t>(6 * row + column)], expected(row, column), 1e-6);
    }
  }
  EXPECT_EQ(message.frame, "odom");
  EXPECT_EQ(message.child_frame, "base_link");
  EXPECT_EQ(message.stamp.seconds, 1'700'000'000U);
  EXPECT_EQ(message.stamp.nanoseconds, 123'456'789U);
}

// The LiDAR, 1 m ahead of the base, turns left on the spot: the base goes to its right. The world is the odometry's
// frame turned about, 5 m away.
TEST(NodeMessages, ThePoseIsThatOfTheBase) {
  const double quarter = std::numbers::pi / 2;
  const SE3 T = base_pose(some_pose(0, 0, 0, {0, 0, quarter}), some_pose(1, 0, 0, {0, 0, 0}),
                          some_pose(5, 0, 0, {0, 0, 2 * quarter}));
  EXPECT_LT((T.translation() - Eigen::Vector3d(4, 1, 0)).norm(), 1e-12);
  EXPECT_LT((T.linear() - so3_exp({0, 0, 3 * quarter})).norm(), 1e-12);
}

TEST(NodeMessages, TheTwistIsThatOfTheBase) {
  const SweepResult result = some_result();
  const SweepResult base = of_base(result, kBaseLidar, SE3::Identity());
  // Both move as one body.
  constexpr double kTime = 1e-6;
  const SE3 later = base_pose(result.T_odom_lidar * se3_exp(kTime * result.twist), kBaseLidar, SE3::Identity());
  const Vector6d expected = se3_log(base.T_odom_lidar.inverse() * later) / kTime;
  const OdometryMessage message = odometry_message(base, 0.1, "odom", "base_link");
  EXPECT_LT((message.angular - expected.head<3>()).norm(), 1e-5);
  EXPECT_LT((message.linear - expected.tail<3>()).norm(), 1e-5);
  // Position before rotation, over the time of a step.
  EXPECT_NEAR(message.twist_covariance[0], base.covariance(3, 3) / 0.01, 1e-9);
  EXPECT_NEAR(message.twist_covariance[21], base.covariance(0, 0) / 0.01, 1e-9);
  EXPECT_GE(odometry_message(base, 0, "odom", "base_link").twist_covariance[0], 1e6);
}

TEST(NodeMessages, TheInverseTransformHasItsFramesChanged) {
  const SweepResult result = some_result();
  const auto there = transform_message(result, false, "odom", "base_link");
  const auto back = transform_message(result, true, "odom", "base_link");
  EXPECT_EQ(there.frame, "odom");
  EXPECT_EQ(there.child_frame, "base_link");
  EXPECT_EQ(back.frame, "base_link");
  EXPECT_EQ(back.child_frame, "odom");
  EXPECT_EQ(there.transform.position.x(), 10);
  EXPECT_NEAR(back.transform.position.x(), result.T_odom_lidar.inverse().translation().x(), 1e-12);
  EXPECT_LT(there.transform.orientation.angularDistance(back.transform.orientation.inverse()), 1e-12);
}

TEST(NodeMessages, OfTwoQuaternionsItIsTheOneWithPositiveW) {
  for (const double yaw : {-3.1, -1.0, 0.0, 2.0, 3.1}) {
    SweepResult result;
    result.T_odom_lidar = some_pose(0, 0, 0, {0, 0, yaw});
    const PoseMessage pose = odometry_message(result, 0, "odom", "base_link").pose;
    EXPECT_GE(pose.orientation.w(), 0);
    EXPECT_NEAR(pose.orientation.norm(), 1, 1e-15);
    EXPECT_TRUE(pose.orientation.toRotationMatrix().isApprox(result.T_odom_lidar.linear(), 1e-12));
  }
}

// ROS 1 has no time before 1970, rclcpp::Time throws, and ROS 2's seconds are an int32.
TEST(NodeMessages, StampsAreSuchAsRosKnows) {
  EXPECT_EQ(node_stamp(-5).seconds, 0U);
  EXPECT_EQ(node_stamp(-5).nanoseconds, 0U);
  EXPECT_EQ(node_stamp(std::numeric_limits<std::int64_t>::min()).seconds, 0U);
  EXPECT_EQ(node_stamp(1'999'999'999).seconds, 1U);
  EXPECT_EQ(node_stamp(1'999'999'999).nanoseconds, 999'999'999U);
  EXPECT_EQ(node_stamp(std::numeric_limits<std::int64_t>::max()).seconds, 2'147'483'647U);
  EXPECT_LT(node_stamp(std::numeric_limits<std::int64_t>::max()).nanoseconds, 1'000'000'000U);
}

TEST(NodeMessages, ThePathEndsWithItsOwnStamp) {
  const Trajectory trajectory{{1'000'000'007, some_pose(1, 2, 3, {0, 0, 0})},
                              {2'000'000'009, some_pose(4, 5, 6, {0, 0, 1})}};
  const PathMessage path = path_message(trajectory, "odom");
  ASSERT_EQ(path.poses.size(), 2U);
  EXPECT_EQ(path.frame, "odom");
  EXPECT_EQ(path.stamp.seconds, 2U);
  EXPECT_EQ(path.stamp.nanoseconds, 9U);
  EXPECT_EQ(path.poses[0].stamp.nanoseconds, 7U);
  EXPECT_EQ(path.poses[1].pose.position, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(path_message({}, "odom").stamp.seconds, 0U);
}

TEST(NodeMessages, CloudsHoldTheirPoints) {
  std::vector<Eigen::Vector3f> points{{1, 2, 3}, {-4, 5, 6.5F}};
  transform_points(some_pose(10, 0, 0, {0, 0, 0}), points);
  const CloudMessage message = cloud_message(points, -5, "odom");
  EXPECT_EQ(message.stamp.seconds, 0U);
  EXPECT_EQ(message.frame, "odom");
  ASSERT_EQ(message.width, 2U);
  ASSERT_EQ(message.data.size(), 2 * kCloudPointBytes);
  std::array<float, 6> values{};
  std::memcpy(values.data(), message.data.data(), sizeof(values));
  EXPECT_EQ(values, (std::array<float, 6>{11, 2, 3, 6, 5, 6.5F}));
  EXPECT_TRUE(cloud_message({}, 0, "odom").data.empty());
}

}  // namespace
}  // namespace rilo
