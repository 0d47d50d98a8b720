// The ROS 1 bag of a run, read by ROS' own library. (Its classes of messages do not compile as C++20; the tests of the
// ROS 1 node read such a bag in Python.)
#include <cmath>
#include <cstring>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include "io/io_test_util.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

SweepResult turned_left(std::int64_t stamp_ns) {
  SweepResult result;
  result.stamp_ns = stamp_ns;
  result.T_odom_lidar.linear() = so3_exp(Eigen::Vector3d(0, 0, 1.5707963267948966));
  result.T_odom_lidar.translation() = Eigen::Vector3d(1, 2, -3);
  result.twist << 0.1, 0.2, 0.3, 4, 5, 6;
  result.covariance.diagonal() << 1, 2, 3, 10, 20, 30;
  return result;
}

std::string bytes_of_message(const rosbag::MessageInstance& message) {
  std::string bytes(message.size(), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
  message.write(stream);
  return bytes;
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(TrajectoryBagTest, OdometryAndTransformsOfEverySweep) {
  ASSERT_TRUE(can_write_bags());
  const TempDir folder;
  RecordingNames names;
  names.odom_frame = "map";
  names.lidar_frame = "os_sensor";
  const std::vector<SweepResult> results = {turned_left(1'700'000'000'123'456'789),
                                            turned_left(1'700'000'000'223'456'789)};
  rilo::write_bag(folder / "run.bag", results, names);
  EXPECT_EQ(files_in(folder.path()), 1U);
  rosbag::Bag bag((folder / "run.bag").string());

  rosbag::View odometry(bag, rosbag::TopicQuery("/odometry"));
  ASSERT_EQ(odometry.size(), 2U);
  EXPECT_EQ(odometry.begin()->getDataType(), "nav_msgs/Odometry");
  EXPECT_EQ(odometry.begin()->getMD5Sum(), ros::message_traits::MD5Sum<nav_msgs::Odometry>::value());
  EXPECT_NE(odometry.begin()->getMessageDefinition().find("geometry_msgs/PoseWithCovariance pose"), std::string::npos);
  const std::string bytes = bytes_of_message(*odometry.begin());
  // seq, sec, nsec, "map", "os_sensor", then 7 + 36 + 6 + 36 numbers.
  constexpr std::size_t kPoseAt = 12 + 4 + 3 + 4 + 9;
  ASSERT_EQ(bytes.size(), kPoseAt + 8 * (7 + 36 + 6 + 36));
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 1'700'000'000U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 8), 123'456'789U);
  EXPECT_EQ(bytes.substr(16, 3), "map");
  EXPECT_EQ(bytes.substr(23, 9), "os_sensor");
  const auto number = [&](std::size_t i) { return at<double>(bytes, kPoseAt + 8 * i); };
  EXPECT_EQ(number(1), 2);
  EXPECT_NEAR(number(5), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(number(6), std::sqrt(0.5), 1e-12);
  // Position first, about the axes of the odometry frame: the sensor's x is its y.
  const std::array<double, 6> diagonal = {20, 10, 30, 2, 1, 3};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(number(7 + 7 * i), diagonal[i], 1e-9) << i;
  EXPECT_EQ(number(43), 4);
  EXPECT_EQ(number(48), 0.3);
  EXPECT_EQ(number(49), 1e6);  // no pose before: the velocity is unknown
  const std::string second = bytes_of_message(*std::next(odometry.begin()));
  const std::array<double, 6> of_velocity = {1000, 2000, 3000, 100, 200, 300};  // over the step of 0.1 s
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(at<double>(second, kPoseAt + 8 * (49 + 7 * i)), of_velocity[i], 1e-6) << i;

  rosbag::View transforms(bag, rosbag::TopicQuery("/tf"));
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_EQ(transforms.begin()->getDataType(), "tf2_msgs/TFMessage");
  const std::string tf = bytes_of_message(*transforms.begin());
  ASSERT_EQ(tf.size(), 4 + kPoseAt + 8 * 7);
  EXPECT_EQ(at<std::uint32_t>(tf, 0), 1U);
  EXPECT_EQ(at<double>(tf, 4 + kPoseAt + 16), -3);
}

TEST(TrajectoryBagTest, StampsThatRosDoesNotKnow) {
  const TempDir folder;
  const std::vector<SweepResult> results = {turned_left(-5), turned_left(0), turned_left(std::int64_t{1} << 62)};
  rilo::write_bag(folder / "run.bag", results);
  rosbag::Bag bag((folder / "run.bag").string());
  rosbag::View odometry(bag, rosbag::TopicQuery("/odometry"));
  std::vector<std::uint32_t> seconds;
  for (const rosbag::MessageInstance& message : odometry) {
    seconds.push_back(at<std::uint32_t>(bytes_of_message(message), 4));
  }
  EXPECT_EQ(seconds, (std::vector<std::uint32_t>{0, 0, 0xFFFFFFFFU}));
}

TEST(TrajectoryBagTest, NoneAndNowhere) {
  const TempDir folder;
  rilo::write_bag(folder / "empty.bag", {});
  rosbag::Bag bag((folder / "empty.bag").string());
  EXPECT_EQ(rosbag::View(bag).size(), 0U);
  expect_io_error([&] { rilo::write_bag(folder / "missing" / "run.bag", {}); }, {"missing"});
}

}  // namespace
}  // namespace rilo::test
