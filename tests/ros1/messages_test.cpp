// What the ROS 1 node publishes, without ROS running.
#include "messages.hpp"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <gtest/gtest.h>

#include "base_frame.hpp"

namespace rilo::ros1 {
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

TEST(Ros1Messages, TheCovarianceIsThatOfSmallDisturbances) {
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
  const nav_msgs::Odometry message = odometry_message(base, 0.1, "odom", "base_link");
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      EXPECT_NEAR(message.pose.covariance[static_cast<std::size_t>(6 * row + column)], expected(row, column), 1e-6);
    }
  }
  EXPECT_EQ(message.header.frame_id, "odom");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.header.stamp.sec, 1'700'000'000U);
  EXPECT_EQ(message.header.stamp.nsec, 123'456'789U);
}

TEST(Ros1Messages, TheTwistIsThatOfTheBase) {
  const SweepResult result = some_result();
  const SweepResult base = of_base(result, kBaseLidar, SE3::Identity());
  // Both move as one body.
  constexpr double kTime = 1e-6;
  const SE3 later = base_pose(result.T_odom_lidar * se3_exp(kTime * result.twist), kBaseLidar, SE3::Identity());
  const Vector6d expected = se3_log(base.T_odom_lidar.inverse() * later) / kTime;
  const nav_msgs::Odometry message = odometry_message(base, 0.1, "odom", "base_link");
  const geometry_msgs::Twist& twist = message.twist.twist;
  EXPECT_LT((Eigen::Vector3d(twist.angular.x, twist.angular.y, twist.angular.z) - expected.head<3>()).norm(), 1e-5);
  EXPECT_LT((Eigen::Vector3d(twist.linear.x, twist.linear.y, twist.linear.z) - expected.tail<3>()).norm(), 1e-5);
  // Position before rotation, over the time of a step.
  EXPECT_NEAR(message.twist.covariance[0], base.covariance(3, 3) / 0.01, 1e-9);
  EXPECT_NEAR(message.twist.covariance[21], base.covariance(0, 0) / 0.01, 1e-9);
  EXPECT_GE(odometry_message(base, 0, "odom", "base_link").twist.covariance[0], 1e6);
}

TEST(Ros1Messages, TheInverseTransformHasItsFramesChanged) {
  const SweepResult result = some_result();
  const auto there = transform_message(result, false, "odom", "base_link");
  const auto back = transform_message(result, true, "odom", "base_link");
  EXPECT_EQ(there.header.frame_id, "odom");
  EXPECT_EQ(there.child_frame_id, "base_link");
  EXPECT_EQ(back.header.frame_id, "base_link");
  EXPECT_EQ(back.child_frame_id, "odom");
  EXPECT_DOUBLE_EQ(there.transform.translation.x, 10);
  EXPECT_NEAR(back.transform.translation.x, result.T_odom_lidar.inverse().translation().x(), 1e-12);
}

TEST(Ros1Messages, CloudsHoldTheirPoints) {
  std::vector<Eigen::Vector3f> points{{1, 2, 3}, {-4, 5, 6.5F}};
  transform_points(some_pose(10, 0, 0, {0, 0, 0}), points);
  const sensor_msgs::PointCloud2 message = cloud_message(points, -5, "odom");
  EXPECT_TRUE(message.header.stamp.isZero());  // ROS knows nothing before 1970
  EXPECT_EQ(message.width, 2U);
  EXPECT_EQ(message.data.size(), static_cast<std::size_t>(message.row_step));
  sensor_msgs::PointCloud2ConstIterator<float> x(message, "x");
  sensor_msgs::PointCloud2ConstIterator<float> z(message, "z");
  EXPECT_FLOAT_EQ(*x, 11);
  EXPECT_FLOAT_EQ(*(z + 1), 6.5F);
}

}  // namespace
}  // namespace rilo::ros1
