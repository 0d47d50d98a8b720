// What a node says on its own: about frames that TF does not take, and about its messages.
#include <algorithm>

#include <gmock/gmock.h>

#include "node/running_node.hpp"

namespace rilo {
namespace {

using test::at_once;
using test::drive;
using test::message;
using test::message_of;
using test::Output;
using test::RunningNode;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

LiveQueue::Message from_frame(std::size_t i, const std::string& frame) {
  LiveQueue::Message named = message(i);
  std::get<LiveCloud>(named.content).message.frame_id = frame;
  return named;
}

// tf2 refuses to look up names that begin with a slash, as drivers of old wrote them.
TEST(LiveWarnings, FramesHaveNoSlashInFront) {
  Output output;
  output.T_base_lidar = SE3::Identity();
  LiveOdometry odometry(with_parameters(at_once(), {{"base_frame", "/base_link"}, {"odom_frame", "/world"}}), "/points",
                        output);
  odometry.start();
  odometry.push(from_frame(0, "/velodyne"));
  ASSERT_TRUE(output.wait_poses(1));
  EXPECT_EQ(odometry.set_initial_pose("/world", {0, 0, 0}, Eigen::Quaterniond::Identity()), "");
  odometry.stop();
  EXPECT_THAT(output.asked, ElementsAre("base_link velodyne"));
  EXPECT_EQ(output.odometry[0].frame, "world");
  EXPECT_EQ(output.odometry[0].child_frame, "base_link");
}

TEST_F(RunningNode, WithoutAFrameOfItsOwnNothingGoesToTf) {
  for (const char* frame : {"", "/odom"}) {
    Output nameless;
    LiveOdometry odometry_of_it(at_once(), "/points", nameless);
    odometry_of_it.start();
    odometry_of_it.push(from_frame(0, frame));
    odometry_of_it.push(from_frame(1, frame));
    ASSERT_TRUE(nameless.wait_poses(2));
    odometry_of_it.stop();
    EXPECT_TRUE(nameless.transforms.empty());
    EXPECT_THAT(nameless.warnings, ElementsAre(HasSubstr("nothing on /tf")));
  }
}

TEST(LiveWarnings, WithoutItsNameTheLidarIsNotLookedUp) {
  Output output;
  NodeOptions options = at_once();
  options.base_frame = "base_link";
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(from_frame(0, ""));
  ASSERT_TRUE(output.wait([&] { return !output.warnings.empty(); }));
  odometry.stop();
  EXPECT_TRUE(output.asked.empty());
  EXPECT_THAT(output.warnings.front(), HasSubstr("base_to_lidar"));
}

TEST(LiveWarnings, APlaceOfTheLidarInItsOwnFrameIsSaid) {
  for (const char* frame : {"velodyne", "base_link"}) {
    Output output;
    NodeOptions options = at_once();
    options.base_frame = frame;
    options.base_to_lidar = {0, 0, 1.7, 0, 0, 0};
    LiveOdometry odometry(options, "/points", output);
    odometry.start();
    odometry.push(from_frame(0, "velodyne"));
    ASSERT_TRUE(output.wait_poses(1));
    odometry.stop();
    if (options.base_frame == "velodyne") {
      EXPECT_THAT(output.warnings, ElementsAre(HasSubstr("base_frame is the messages' own frame, velodyne")));
    } else {
      EXPECT_TRUE(output.warnings.empty());
    }
  }
}

TEST_F(RunningNode, WhatTheReaderWarnsOfIsSaidOnce) {
  push(0, 2);
  odometry.push(message(1));  // a duplicate
  auto late = std::make_shared<Sweep>(drive()[3]);
  late->stamp_ns += 700'000'000;
  odometry.push(message_of(late));
  odometry.push(message(4));
  auto last = std::make_shared<Sweep>(drive()[5]);
  last->stamp_ns += 600'000'000;
  odometry.push(message_of(last));
  ASSERT_TRUE(output.wait_poses(4));
  odometry.stop();
  EXPECT_THAT(output.warnings, ElementsAre(HasSubstr("the same sweep again"), HasSubstr("a gap of"),
                                           HasSubstr("older than a sweep before"), HasSubstr("lost (")));
}

TEST(LiveWarnings, AFieldThatMayHoldTheTimesIsNamed) {
  Output output;
  NodeOptions options = at_once();
  options.look_ahead = 2;
  options.source.point_times = PointTimes::kAuto;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  for (std::size_t i = 0; i < 2; ++i) {
    LiveQueue::Message timed = message(i);
    PointCloud2& cloud = std::get<LiveCloud>(timed.content).message;
    cloud.fields.push_back({"firing_time_of_it", 8, 7, 1});
    odometry.push(std::move(timed));
  }
  ASSERT_TRUE(output.wait_poses(2));
  odometry.stop();
  EXPECT_THAT(output.warnings, Contains(HasSubstr("firing_time_of_it")));
  EXPECT_THAT(output.warnings, Contains(HasSubstr("no times of the points")));
}

TEST(LiveWarnings, PointsWithoutTimesAreSaid) {
  Output output;
  NodeOptions options = at_once();
  options.source.point_times = PointTimes::kAuto;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  auto empty = std::make_shared<Sweep>();
  odometry.push(message_of(empty));
  for (std::size_t i = 1; i < 4; ++i) odometry.push(message(i));
  ASSERT_TRUE(output.wait_poses(4));
  odometry.stop();
  const auto said = [](const std::string& warning) { return warning.find("point_times") != std::string::npos; };
  EXPECT_EQ(std::count_if(output.warnings.begin(), output.warnings.end(), said), 1);
}

TEST(LiveWarnings, DroppedSweepsAreSaid) {
  Output output;
  NodeOptions options = at_once();
  options.queue = 1;
  options.base_frame = "base_link";  // while that is awaited, no sweep is taken
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  ASSERT_TRUE(output.wait([&] { return !output.asked.empty(); }));
  for (std::size_t i = 1; i < 5; ++i) odometry.push(message(i));
  {
    const std::lock_guard lock(output.mutex);
    output.T_base_lidar = SE3::Identity();
  }
  ASSERT_TRUE(output.wait_poses(2));
  odometry.stop();
  EXPECT_THAT(output.warnings, Contains(HasSubstr("3 sweeps dropped")));
}

}  // namespace
}  // namespace rilo
