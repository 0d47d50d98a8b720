// What changes under a running node: clocks, the driver, the place. And what it says of it.
#include <string>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "node/running_node.hpp"

namespace rilo {
namespace {

using test::at_once;
using test::drive;
using test::expect_pose;
using test::kSweeps;
using test::message;
using test::message_of;
using test::Output;
using test::RunningNode;
using test::value_of;
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kHourNs = 3'600'000'000'000;

std::shared_ptr<Sweep> stamped(const Sweep& sweep, std::int64_t stamp_ns) {
  auto other = std::make_shared<Sweep>(sweep);
  other->stamp_ns = stamp_ns;
  return other;
}

// Of another town.
Sweep elsewhere(std::size_t i, std::int64_t stamp_ns) {
  static const std::vector<Sweep> kOther = [] {
    DriveConfig config;
    config.sensor = SensorKind::kVlp16;
    config.sweeps = 8;
    config.start_s = 60.0;
    config.seed = 7;
    config.deskewed = true;
    const DriveSimulator simulator(config);
    std::vector<Sweep> sweeps;
    for (std::size_t k = 0; k < config.sweeps; ++k) sweeps.push_back(simulator.sweep(k).sweep);
    return sweeps;
  }();
  Sweep sweep = kOther.at(i);
  sweep.stamp_ns = stamp_ns;
  sweep.rings.clear();
  return sweep;
}

// The sensor moves on, whatever one stamp or a clock says: poses are those of the library, which is told the same.
TEST(LiveChanges, AWrongStampOrAClockThatIsSetDoesNotRestart) {
  struct Fault {
    const char* name;
    std::int64_t only_ns;  // added to one stamp ...
    std::int64_t then_ns;  // ... and to all after it
  };
  for (const Fault& fault : {Fault{"ahead", kHourNs, 0}, Fault{"back", -2'000'000'000, 0},
                             Fault{"clock set back", -2'000'000'000, -2'000'000'000}}) {
    SCOPED_TRACE(fault.name);
    Output output;
    LiveOdometry odometry(at_once(), "/points", output);
    odometry.start();
    Odometry library(OdometryConfig{});
    for (std::size_t i = 0; i < kSweeps; ++i) {
      const std::int64_t wrong_ns = i < 5 ? 0 : i == 5 ? fault.only_ns : fault.then_ns;
      const auto sweep = stamped(drive()[i], drive()[i].stamp_ns + 10'000'000'000 + wrong_ns);
      odometry.push(message_of(sweep));
      ASSERT_TRUE(output.wait_poses(i + 1));
      expect_pose(output.odometry[i].pose, library.register_sweep(*sweep).T_odom_lidar);
    }
    odometry.stop();
    const StatusMessage report = odometry.report();
    EXPECT_EQ(value_of(report, "resets"), "0");
    EXPECT_EQ(value_of(report, "status ok"), "9");
    EXPECT_GT(output.odometry.back().pose.position.norm(), 1);
    EXPECT_THAT(output.warnings, Contains(HasSubstr("the odometry goes on")));
  }
}

TEST_F(RunningNode, ABagOfAnotherPlaceThatIsPlayedAgainStartsAnew) {
  push(0, 8);
  odometry.push(message_of(std::make_shared<Sweep>(elsewhere(0, -5'000'000'000))));
  ASSERT_TRUE(output.wait_poses(9));
  odometry.stop();
  EXPECT_EQ(output.odometry[8].pose.position, Eigen::Vector3d::Zero());
  EXPECT_EQ(value_of(odometry.report(), "resets"), "1");
  EXPECT_EQ(odometry.path().poses.size(), 1U);
  EXPECT_THAT(output.warnings, Contains(HasSubstr("the odometry restarts")));
}

// A driver that was started again with another frame: what it sends is refused, until the node is told.
TEST_F(RunningNode, AResetTakesMessagesOfAnotherFrame) {
  push(0, 2);
  const auto of_frame = [](std::size_t i) {
    LiveQueue::Message other = message(i);
    std::get<LiveCloud>(other.content).message.frame_id = "os_lidar";
    return other;
  };
  odometry.push(of_frame(2));
  ASSERT_TRUE(output.wait([&] { return !output.warnings.empty(); }));
  EXPECT_THAT(output.warnings.back(), HasSubstr("dropped"));
  odometry.reset();
  odometry.push(of_frame(3));
  odometry.push(of_frame(4));
  ASSERT_TRUE(output.wait_poses(4));
  odometry.stop();
  EXPECT_EQ(output.odometry[1].child_frame, "velodyne");
  EXPECT_EQ(output.odometry[2].child_frame, "os_lidar");
  EXPECT_EQ(output.odometry[2].pose.position, Eigen::Vector3d::Zero());
  EXPECT_EQ(output.transforms[3].child_frame, "os_lidar");
}

// It waits for the first messages, to look at them, when it is told to look anew.
TEST(LiveChanges, AResetBeforeTheFirstMessageOrWhileLookingAhead) {
  NodeOptions options = at_once();
  options.look_ahead = 3;
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.reset();
  odometry.push(message(0));
  odometry.reset();
  for (std::size_t i = 1; i < 6; ++i) odometry.push(message(i));
  ASSERT_TRUE(output.wait_poses(5));
  odometry.stop();
  EXPECT_TRUE(output.failures.empty());
  EXPECT_EQ(value_of(odometry.report(), "resets"), "2");
  EXPECT_GE(std::stoi(value_of(odometry.report(), "sweeps registered")), 5);
}

TEST(LiveChanges, ALossAndANewMapAreToldAndSavedMapsSaySo) {
  NodeOptions options = at_once();
  options.config.health.restart_after = 3;
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  for (std::size_t i = 0; i < 5; ++i) odometry.push(message(i));
  ASSERT_TRUE(output.wait_poses(5));
  odometry.report();
  for (std::size_t i = 0; i < 8; ++i) {
    const auto stamp_ns = static_cast<std::int64_t>(i + 6) * 100'000'000;
    odometry.push(message_of(std::make_shared<Sweep>(elsewhere(i, stamp_ns))));
  }
  ASSERT_TRUE(output.wait_poses(13));
  EXPECT_THAT(output.warnings, Contains(HasSubstr("lost (")));
  EXPECT_THAT(output.warnings, Contains(HasSubstr("a new map begins")));
  const StatusMessage report = odometry.report();
  EXPECT_EQ(report.level, NodeLevel::kError);
  EXPECT_THAT(report.message, HasSubstr("since the last report"));
  EXPECT_THAT(report.message, HasSubstr("1 new map began"));
  EXPECT_EQ(value_of(report, "new maps"), "1");
  const test::TempDir folder;
  EXPECT_THAT(odometry.save_map((folder.path() / "map.ply").string()).message, HasSubstr("2 maps"));
  odometry.reset();
  EXPECT_EQ(value_of(odometry.report(), "new maps"), "0");
}

TEST(LiveChanges, TheSavedMapHasALimit) {
  NodeOptions options = at_once();
  options.map_points = 1000;
  Output output;
  LiveOdometry odometry(options, "/points", output);
  odometry.start();
  odometry.push(message(0));
  odometry.push(message(1));
  ASSERT_TRUE(output.wait_poses(2));
  odometry.push(message(2));
  ASSERT_TRUE(output.wait_poses(3));
  odometry.stop();
  const test::TempDir folder;
  const LiveOdometry::SavedMap saved = odometry.save_map((folder.path() / "map.ply").string());
  const StatusMessage report = odometry.report();
  EXPECT_EQ(value_of(report, "points of the map for save_map"), std::to_string(saved.points));
  EXPECT_GE(saved.points, 1000U);
  EXPECT_EQ(report.level, NodeLevel::kWarn);
  EXPECT_THAT(report.message, HasSubstr("takes no more"));
}

}  // namespace
}  // namespace rilo
