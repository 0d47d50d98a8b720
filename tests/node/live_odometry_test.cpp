// A node without ROS: messages in, what is published, services, parameters at run time.
#include "rilo/node/live_odometry.hpp"

#include <algorithm>
#include <filesystem>
#include <mutex>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "node/running_node.hpp"
#include "rilo/node/node_parameters.hpp"

namespace rilo {
namespace {

using test::at_once;
using test::drive;
using test::expect_pose;
using test::expected_poses;
using test::kSweeps;
using test::message;
using test::message_of;
using test::Output;
using test::RunningNode;
using test::value_of;
using testing::HasSubstr;

TEST_F(RunningNode, PosesAreThoseOfTheLibrary) {
  push(0, kSweeps);
  odometry.stop();
  const std::vector<SE3> expected = expected_poses(kSweeps);
  ASSERT_EQ(output.transforms.size(), kSweeps);
  for (std::size_t i = 0; i < kSweeps; ++i) {
    expect_pose(output.odometry[i].pose, expected[i]);
    expect_pose(output.transforms[i].transform, expected[i]);
    EXPECT_EQ(output.odometry[i].frame, "odom");
    EXPECT_EQ(output.odometry[i].child_frame, "velodyne");
  }
  EXPECT_GT(expected.back().translation().norm(), 1);
  ASSERT_EQ(output.paths.size(), kSweeps);
  ASSERT_EQ(output.paths.back().poses.size(), kSweeps);
  expect_pose(output.paths.back().poses[4].pose, expected[4]);
  EXPECT_GT(output.maps.back().width, 1000U);
  EXPECT_EQ(odometry.path().poses.size(), kSweeps);
  EXPECT_EQ(odometry.local_map().data, output.maps.back().data);
  EXPECT_EQ(value_of(odometry.report(), "sweeps registered"), "10");
  EXPECT_TRUE(output.failures.empty());
}

TEST(LiveOdometry, BeginsWithTheAnglesOfItsSensorAndAgainAfterAReset) {
  Odometry learning(OdometryConfig{});
  for (const Sweep& sweep : drive()) learning.register_sweep(sweep);
  NodeOptions options = at_once();
  options.calibration = learning.sensor_angles();
  options.calibration->elevation_offset_rad = 0.005;
  Odometry library(OdometryConfig{});
  library.start_with(*options.calibration);
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  for (std::size_t i = 0; i < kSweeps; ++i) {
    if (i == 3) {  // another configuration makes a new odometry: that one knows the sensor, too
      odometry.set_parameters({{"icp.max_iterations", std::int64_t{23}}});
      odometry.reset();
      OdometryConfig changed;
      changed.icp.max_iterations = 23;
      library = Odometry(changed);
      library.start_with(*options.calibration);
    }
    odometry.push(message(i));
    ASSERT_TRUE(output.wait_poses(i + 1));
    expect_pose(output.odometry.back().pose, library.register_sweep(drive()[i]).T_odom_lidar);
  }
}

TEST(LiveOdometry, TheAnglesOfAnotherSensorEndIt) {
  NodeOptions options = at_once();
  options.calibration.emplace();
  options.calibration->beams.push_back({3, 0.5, 0.0, 0.0});
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  ASSERT_TRUE(output.wait([&] { return !output.failures.empty(); }));
  EXPECT_THAT(output.failures.front(), HasSubstr("calibration: of another sensor"));
  EXPECT_TRUE(output.odometry.empty());
}

TEST(LiveOdometry, PathAndMapComeWithTheirPeriodsAndWhenWanted) {
  Output output;
  NodeOptions options = at_once();
  options.path_period_s = 0.25;
  options.local_map_period_s = 1e6;
  options.publish_tf = false;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  for (std::size_t i = 0; i < 7; ++i) odometry.push(message(i));
  ASSERT_TRUE(output.wait_poses(7));
  odometry.stop();
  EXPECT_EQ(output.paths.size(), 3U);  // at 0, 0.3 and 0.6 s
  EXPECT_EQ(output.maps.size(), 1U);
  EXPECT_TRUE(output.transforms.empty());

  Output nobody;
  nobody.wanted = false;
  LiveOdometry quiet(at_once(), "/points", nobody);
  quiet.start();
  quiet.push(message(0));
  ASSERT_TRUE(nobody.wait_poses(1));
  quiet.stop();
  EXPECT_TRUE(nobody.paths.empty());
  EXPECT_TRUE(nobody.maps.empty());
}

TEST_F(RunningNode, SetPoseMovesWhatFollowsAndThePath) {
  push(0, 3);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(odometry.set_pose({100, -50, 3}, turned), "");
  push(3, 4);
  const std::vector<SE3> poses = expected_poses(4);
  SE3 wanted = SE3::Identity();
  wanted.linear() = turned.toRotationMatrix();
  wanted.translation() << 100, -50, 3;
  const SE3 expected = wanted * poses[2].inverse() * poses[3];
  EXPECT_LT((output.odometry[3].pose.position - expected.translation()).norm(), 1e-9);
  EXPECT_LT((odometry.path().poses[2].pose.position - wanted.translation()).norm(), 1e-9);
  EXPECT_THAT(odometry.set_pose({0, 0, 0}, Eigen::Quaterniond(0, 0, 0, 0)), HasSubstr("length 1"));
  EXPECT_THAT(odometry.set_pose({std::nan(""), 0, 0}, turned), HasSubstr("finite"));
  EXPECT_THAT(odometry.set_initial_pose("map", {0, 0, 0}, turned), HasSubstr("expected odom"));
  EXPECT_EQ(odometry.set_initial_pose("odom", {1, 2, 3}, turned), "");
  EXPECT_LT((odometry.path().poses[3].pose.position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9);
}

TEST(LiveOdometry, AfterAResetPathsAndMapsComeAtOnceAndOfNothingBefore) {
  Output output;
  NodeOptions options = at_once();
  options.path_period_s = options.local_map_period_s = 1e6;
  options.map_voxel_m = 0.5;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  odometry.push(message(1));
  ASSERT_TRUE(output.wait_poses(2));
  odometry.reset();
  const test::TempDir folder;
  EXPECT_EQ(odometry.save_map((folder.path() / "map.ply").string()).points, 0U);
  odometry.push(message(2));
  ASSERT_TRUE(output.wait_poses(3));
  odometry.stop();
  EXPECT_EQ(output.paths.size(), 2U);
  EXPECT_EQ(output.maps.size(), 2U);
}

TEST_F(RunningNode, KeysOfTheConfigurationCountFromTheNextResetOn) {
  push(0, 3);
  EXPECT_TRUE(odometry.set_parameters({{"preprocess.source_points", std::int64_t{500}}, {"publish_tf", true}}));
  EXPECT_FALSE(odometry.set_parameters({{"publish_tf", false}}));
  EXPECT_THROW(odometry.set_parameters({{"publish_tf", true}, {"queue", std::int64_t{3}}}), std::invalid_argument);
  EXPECT_THROW(odometry.set_parameters({{"icp.max_iterations", std::int64_t{-3}}}), std::invalid_argument);
  push(3, 4);
  expect_pose(output.odometry[3].pose, expected_poses(4)[3]);
  odometry.reset();
  push(4, 7);
  EXPECT_EQ(output.transforms.size(), 3U);
  OdometryConfig config;
  config.preprocess.source_points = 500;
  Odometry few(config);
  Odometry many{OdometryConfig{}};
  for (std::size_t i = 4; i < 7; ++i) {
    const SE3 T = few.register_sweep(drive()[i]).T_odom_lidar;
    expect_pose(output.odometry[i].pose, T);
    EXPECT_EQ(many.register_sweep(drive()[i]).T_odom_lidar.isApprox(T, 0), i == 4);
  }
  EXPECT_EQ(odometry.path().poses.size(), 3U);
}

// The thread reads the frames while others change what may be changed: a thread sanitizer sees it.
TEST(LiveOdometry, ParametersMayChangeWhileTheFramesAreRead) {
  Output output;
  NodeOptions options = at_once();
  options.odom_frame = "a name that is longer than a string holds in place";
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  bool inverted = false;
  while (!output.has_poses(1)) {
    inverted = !inverted;
    odometry.set_parameters({{"invert_tf", inverted}});
  }
  odometry.stop();
  EXPECT_EQ(output.odometry[0].frame, options.odom_frame);
  EXPECT_TRUE(output.warnings.empty());
}

TEST_F(RunningNode, AMessageThatCannotBeReadIsLeftOut) {
  LiveQueue::Message broken = message(1);
  std::get<LiveCloud>(broken.content).message.width *= 2;
  odometry.push(message(0));
  odometry.push(broken);
  odometry.push({0, "no message of ROS 1"});
  odometry.push(message(2));
  ASSERT_TRUE(output.wait_poses(2));
  odometry.note_bad_message("of another type");
  odometry.note_lost(5);
  const StatusMessage report = odometry.report();
  EXPECT_EQ(value_of(report, "messages that cannot be read"), "3");
  EXPECT_EQ(value_of(report, "messages lost on the way"), "5");
  EXPECT_THAT(output.warnings.front(), HasSubstr("message 2 of /points"));
  EXPECT_EQ(std::count_if(output.warnings.begin(), output.warnings.end(),
                          [](const std::string& warning) { return warning.rfind("dropped: ", 0) == 0; }),
            1);  // once in a while is enough
}

// rclcpp::Time throws on times before 1970.
TEST_F(RunningNode, NoStampIsNegative) {
  auto early = std::make_shared<Sweep>(drive()[0]);
  early->stamp_ns = -3'000'000'000;
  odometry.push(message_of(early));
  ASSERT_TRUE(output.wait_poses(1));
  odometry.stop();
  EXPECT_EQ(output.odometry[0].stamp.seconds, 0U);
  EXPECT_EQ(odometry.local_map().stamp.seconds, 0U);
  EXPECT_EQ(odometry.path().poses[0].stamp.seconds, 0U);
}

TEST_F(RunningNode, TheMapIsSaved) {
  const test::TempDir folder;
  push(0, 3);
  const auto file = folder.path() / "map.ply";
  const LiveOdometry::SavedMap saved = odometry.save_map(file.string());
  EXPECT_TRUE(saved.success) << saved.message;
  EXPECT_GT(saved.points, 1000U);
  EXPECT_GT(std::filesystem::file_size(file), 12 * saved.points);
  EXPECT_THAT(saved.message, HasSubstr(file.string()));
  const LiveOdometry::SavedMap refused = odometry.save_map((folder.path() / "map.txt").string());
  EXPECT_FALSE(refused.success);
  EXPECT_THAT(refused.message, HasSubstr("map.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "map.txt"));
  odometry.reset();
  const LiveOdometry::SavedMap nothing = odometry.save_map(file.string());
  EXPECT_FALSE(nothing.success);
  EXPECT_THAT(nothing.message, HasSubstr("no points"));
  EXPECT_GT(std::filesystem::file_size(file), 12 * saved.points);  // the map of before the reset
}

}  // namespace
}  // namespace rilo
