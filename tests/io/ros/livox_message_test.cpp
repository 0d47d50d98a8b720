// CustomMsg of livox_ros_driver and livox_ros_driver2.
#include <random>

#include "io/ros/driver_messages.hpp"
#include "io/ros/scan_containers.hpp"

namespace rilo::test {
namespace {

constexpr std::int64_t kFirstLivoxStamp = 1'700'000'000'250'000'000;
constexpr std::uint32_t kPoints = 41;

// Point k of a message is fired k · 2 ms after the stamp.
std::string livox_message(bool ros1, std::size_t number, std::uint32_t announced = kPoints) {
  const std::int64_t stamp_ns = kFirstLivoxStamp + static_cast<std::int64_t>(number) * 100'000'000;
  Bytes bytes(!ros1);
  put_header(bytes, ros1, stamp_ns, "livox_frame");
  bytes.put(static_cast<std::uint64_t>(stamp_ns)).put(kPoints).put(std::uint8_t{3}).raw("rsv").put(announced);
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    bytes.put(k * 2'000'000);
    bytes.put(static_cast<float>(number) + 1.5F).put(static_cast<float>(k)).put(-0.25F);
    bytes.put(static_cast<std::uint8_t>(k + 100)).put(std::uint8_t{0x10}).put(static_cast<std::uint8_t>(k % 4));
  }
  return finished(bytes, ros1);
}

std::vector<Recorded> messages(bool ros1) {
  std::vector<Recorded> all;
  for (std::size_t i = 0; i < 5; ++i) {
    all.push_back({"/livox/lidar", kFirstLivoxStamp + static_cast<std::int64_t>(i) * 100'000'000 + 105'000'000,
                   livox_message(ros1, i)});
    all.push_back({"/livox/imu", all.back().received_ns, "nothing that is read"});
  }
  return all;
}

TEST(LivoxTest, BothDriversInEveryContainer) {
  for (const std::string package : {"livox_ros_driver", "livox_ros_driver2", "livox_interfaces"}) {
    const TempDir folder;
    for (const auto& path : in_every_container(
             folder, {{"/livox/lidar", package, "CustomMsg"}, {"/livox/imu", "sensor_msgs", "Imu"}}, messages)) {
      SCOPED_TRACE(package + ", " + path.filename().string());
      const auto source = open_scan_source(path);
      EXPECT_EQ(source->size(), 5U);
      const auto sweeps = sweeps_of(*source);
      ASSERT_EQ(sweeps.size(), 5U);
      for (std::size_t i = 0; i < sweeps.size(); ++i) {
        const Sweep& sweep = sweeps[i];
        EXPECT_EQ(sweep.stamp_ns, kFirstLivoxStamp + static_cast<std::int64_t>(i) * 100'000'000);
        ASSERT_EQ(sweep.points.size(), kPoints);
        EXPECT_EQ(sweep.points[7], Eigen::Vector3f(static_cast<float>(i) + 1.5F, 7, -0.25F));
        EXPECT_EQ(sweep.intensities[7], 107);
        EXPECT_EQ(sweep.rings[7], 3);
        EXPECT_EQ(sweep.times_s[7], 0.014F);
        EXPECT_EQ(sweep.times_s[40], 0.08F);
      }
      const SourceInfo info = source->info();
      EXPECT_EQ(info.topic, "/livox/lidar");
      EXPECT_EQ(info.frame_id, "livox_frame");
      EXPECT_EQ(info.point_times, "field offset_time (uint32), ns since the sweep's stamp");
      EXPECT_EQ(info.period_s, 0.1);
      EXPECT_EQ(info.faults, StampFaults{});
    }
  }
}

// A sweep of 10 µs would be s, ms and µs by its span alone: the message's definition says ns.
TEST(LivoxTest, TheUnitIsNotInferred) {
  const TempDir folder;
  Bytes bytes(true);
  put_header(bytes, false, kFirstLivoxStamp, "l");
  bytes.put(std::uint64_t{0}).put(std::uint32_t{2}).put(std::uint32_t{0}).put(std::uint32_t{2});
  for (const std::uint32_t time : {0U, 10'000U}) {
    bytes.put(time).put(1.0F).put(2.0F).put(3.0F).put(std::uint8_t{1}).put(std::uint8_t{0}).put(std::uint8_t{0});
  }
  const auto file = folder.write("l.mcap", mcap_bytes({{"/l", "livox_ros_driver2/msg/CustomMsg"}},
                                                      {{"/l", kFirstLivoxStamp, finished(bytes, false)}}, {}));
  const auto sweeps = sweeps_of(*open_scan_source(file));
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].times_s[1], 1e-5F);
}

// livox_ros_driver publishes all its sensors under one name, unless multi_topic is set.
TEST(LivoxTest, ASecondSensorInTheTopicIsNamed) {
  const TempDir folder;
  auto all = messages(false);
  const std::size_t id = all[2].bytes.find("rsv") - 1;
  all[2].bytes[id] = 4;
  const auto file = folder.write(
      "l.mcap", mcap_bytes({{"/livox/lidar", "livox_ros_driver2/msg/CustomMsg"}, {"/livox/imu", "sensor_msgs/msg/Imu"}},
                           all, {}));
  const auto source = open_scan_source(file);
  EXPECT_TRUE(source->next());
  expect_io_error([&] { source->next(); }, {"message 2 of /livox/lidar", "LiDAR 4", "LiDAR 3", "one sensor"});
  EXPECT_TRUE(source->next());
}

TEST(LivoxTest, CutOffAtEveryByte) {
  for (const bool ros1 : {true, false}) {
    const std::string whole = livox_message(ros1, 0);
    const auto encoding = ros1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
    EXPECT_EQ(detail::parse_livox(whole, encoding, {"l.bag"}).cloud.points.size(), kPoints);
    expect_refused_cuts(whole,
                        [&](const std::string& cut) {
                          detail::parse_livox(cut, encoding, {"l.bag", "message 1 of /l"});
                        },
                        {"l.bag", "message 1 of /l", "byte"});
  }
}

TEST(LivoxTest, HostileBytes) {
  expect_io_error(
      [] { detail::parse_livox(livox_message(false, 0, 4'000'000'000U), MessageEncoding::kCdr, {"l.mcap"}); },
      {"l.mcap", "4000000000 points", "is not a Livox CustomMsg"});
  std::mt19937 random(11);
  for (int round = 0; round < 3000; ++round) {
    const bool ros1 = round % 2 == 0;
    std::string bytes = livox_message(ros1, 0);
    for (int k = 0; k < 3; ++k) bytes[random() % 60] = static_cast<char>(random());
    const auto encoding = ros1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
    reads_or_refuses([&] { EXPECT_LE(detail::parse_livox(bytes, encoding, {"l.bag"}).cloud.points.size(), kPoints); });
  }
}

TEST(LivoxTest, ATruncatedMessageIsAnErrorOrCounted) {
  const TempDir folder;
  auto all = messages(false);
  all[4].bytes.resize(200);
  const auto file = folder.write(
      "l.mcap", mcap_bytes({{"/livox/lidar", "livox_ros_driver2/msg/CustomMsg"}, {"/livox/imu", "sensor_msgs/msg/Imu"}},
                           all, {}));
  const auto failing = open_scan_source(file);
  EXPECT_TRUE(failing->next() && failing->next());
  expect_io_error([&] { failing->next(); }, {"l.mcap", "message 3 of /livox/lidar", "byte"});
  EXPECT_TRUE(failing->next());
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto skipping = open_scan_source(file, options);
  EXPECT_EQ(sweeps_of(*skipping).size(), 4U);
  EXPECT_EQ(skipping->info().bad_sweeps, 1U);
}

}  // namespace
}  // namespace rilo::test
