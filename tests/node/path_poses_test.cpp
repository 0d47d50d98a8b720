// The path of a long run: bounded, with its first and newest pose.
#include "node/path_poses.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

StampedPose pose_at(double x_m, std::int64_t stamp_ns) {
  StampedPose pose;
  pose.stamp_ns = stamp_ns;
  pose.T_odom_lidar = SE3(Eigen::Translation3d(x_m, 0.0, 0.0));
  return pose;
}

TEST(PathPoses, KeepsAllOfAShortRun) {
  PathPoses path;
  EXPECT_TRUE(path.poses().empty());
  for (int i = 0; i < 500; ++i) path.add(pose_at(0.001 * i, i));
  const Trajectory poses = path.poses();
  ASSERT_EQ(poses.size(), 500U);
  EXPECT_EQ(poses[123].stamp_ns, 123);
}

TEST(PathPoses, AreBoundedHoweverLongTheRun) {
  PathPoses path;
  constexpr std::int64_t kPoses = 200'000;
  for (std::int64_t i = 0; i < kPoses; ++i) {
    path.add(pose_at(static_cast<double>(i), i));  // 200 km
    ASSERT_LE(i % 1000 == 0 ? path.poses().size() : 0, PathPoses::kMost);
  }
  const Trajectory poses = path.poses();
  EXPECT_GT(poses.size(), PathPoses::kMost / 4);
  EXPECT_EQ(poses.front().stamp_ns, 0);
  EXPECT_EQ(poses.back().stamp_ns, kPoses - 1);
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double step_m = (poses[i].T_odom_lidar.translation() - poses[i - 1].T_odom_lidar.translation()).x();
    ASSERT_GE(step_m, 20.0) << i;
    ASSERT_LE(step_m, 40.0) << i;
  }
}

TEST(PathPoses, OfASensorThatStandsAreFew) {
  PathPoses path;
  for (std::int64_t i = 0; i < 50'000; ++i) path.add(pose_at(0.0, i));
  EXPECT_LT(path.poses().size(), PathPoses::kMost);
  EXPECT_EQ(path.poses().back().stamp_ns, 49'999);
}

}  // namespace
}  // namespace rilo
