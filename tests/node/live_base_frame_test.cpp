// A node whose poses, maps and speeds are those of the robot's base, not of the LiDAR.
#include <cstring>
#include <mutex>

#include <gmock/gmock.h>

#include "node/base_frame.hpp"
#include "node/running_node.hpp"
#include "rilo/node/live_odometry.hpp"
#include "rilo/node/node_parameters.hpp"

namespace rilo {
namespace {

using test::at_once;
using test::drive;
using test::message;
using test::Output;
using test::value_of;
using testing::HasSubstr;

TEST(LiveOdometry, TheTransformOfTheBaseIsLookedUpOnce) {
  Output output;
  NodeOptions options = at_once();
  options.base_frame = "base_link";
  options.queue = 1;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  ASSERT_TRUE(output.wait([&] { return output.asked.size() >= 2; }));
  EXPECT_EQ(odometry.report().level, NodeLevel::kError);
  for (std::size_t i = 1; i < 5; ++i) odometry.push(message(i));  // the freshest one stays
  const SE3 T_base_lidar = pose_from_list({1, 0, 2, 0.5, 0, 0});
  {
    const std::lock_guard lock(output.mutex);
    output.T_base_lidar = T_base_lidar;
  }
  ASSERT_TRUE(output.wait_poses(2));
  const std::size_t asked = output.asked.size();
  odometry.push(message(5));
  ASSERT_TRUE(output.wait_poses(3));
  odometry.stop();
  EXPECT_EQ(output.asked.size(), asked);
  EXPECT_EQ(output.asked.front(), "base_link velodyne");
  EXPECT_EQ(value_of(odometry.report(), "sweeps dropped"), "3");
  ASSERT_FALSE(output.warnings.empty());
  EXPECT_THAT(output.warnings.front(), HasSubstr("base_link to velodyne"));
  Odometry library{OdometryConfig{}};
  for (const std::size_t i : {0U, 4U}) {
    const SE3 T = library.register_sweep(drive()[i]).T_odom_lidar;
    const PoseMessage& pose = output.odometry[i == 0 ? 0 : 1].pose;
    EXPECT_LT((pose.position - base_pose(T, T_base_lidar, SE3::Identity()).translation()).norm(), 1e-12);
  }
  EXPECT_EQ(output.odometry.back().child_frame, "base_link");
}

TEST(LiveOdometry, StoppingEndsTheWaitForATransform) {
  Output output;
  NodeOptions options = at_once();
  options.base_frame = "base_link";
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  ASSERT_TRUE(output.wait([&] { return !output.asked.empty(); }));
  odometry.stop();
  EXPECT_TRUE(output.odometry.empty());
}

std::vector<Eigen::Vector3f> points_of(const CloudMessage& cloud) {
  std::vector<Eigen::Vector3f> points(cloud.width);
  std::memcpy(points.data()->data(), cloud.data.data(), cloud.data.size());
  return points;
}

// 0.5 m above the base, and turned: given, so it is not looked up. What is set moves the map with the poses.
TEST(LiveOdometry, MapsAndSpeedsAreThoseOfTheBase) {
  NodeOptions options = at_once();
  options.base_frame = "base_link";
  options.base_to_lidar = {1, 0, 0.5, 1.5, 0, 0};
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  Odometry library(OdometryConfig{});
  const SE3 T_base_lidar = pose_from_list(options.base_to_lidar);
  SE3 T_odom_base = SE3::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    odometry.push(message(i));
    ASSERT_TRUE(output.wait_poses(i + 1));
    const SweepResult result = of_base(library.register_sweep(drive()[i]), T_base_lidar, SE3::Identity());
    T_odom_base = result.T_odom_lidar;
    EXPECT_EQ(output.odometry.back().twist_covariance,
              odometry_message(result, i == 0 ? 0 : 0.1, "", "").twist_covariance);
  }
  EXPECT_TRUE(output.asked.empty());
  const Eigen::Vector3d first = library.local_map().front().cast<double>();
  const auto shown = [&] { return points_of(odometry.local_map()).front(); };
  EXPECT_LT((shown() - (T_base_lidar * first).cast<float>()).norm(), 1e-4F);
  const SE3 wanted = pose_from_list({100, -50, 3, 1.2, 0, 0});
  EXPECT_EQ(odometry.set_initial_pose("", wanted.translation(), Eigen::Quaterniond(wanted.linear())), "");
  EXPECT_LT((shown() - (wanted * T_odom_base.inverse() * T_base_lidar * first).cast<float>()).norm(), 1e-4F);
}

}  // namespace
}  // namespace rilo
