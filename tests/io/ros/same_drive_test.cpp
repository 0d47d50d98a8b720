// One simulated drive in every format: the same sweeps and the same trajectory, bit for bit.
#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

std::vector<Sweep> sweeps_since_epoch() {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = 6;
  config.start_s = 20;
  const DriveSimulator drive(config);
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    sweeps.push_back(drive.sweep(i).sweep);
    sweeps.back().stamp_ns += 1'700'000'000'000'000'000;
  }
  return sweeps;
}

std::vector<SE3> trajectory(const fs::path& path, const SourceOptions& options = {}) {
  Odometry odometry({});
  const auto source = open_scan_source(path, options);
  std::vector<SE3> poses;
  while (const auto sweep = source->next()) poses.push_back(odometry.register_sweep(*sweep).T_odom_lidar);
  return poses;
}

void expect_equal(const std::vector<SE3>& poses, const std::vector<SE3>& expected) {
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].matrix(), expected[i].matrix()) << i;
}

std::string bin_with_time(const Sweep& sweep) {
  Bytes bytes;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) bytes.put(sweep.points[i][axis]);
    bytes.put(sweep.intensities[i]).put(sweep.times_s[i]);
  }
  return bytes.text;
}

TEST(SameDriveTest, EveryFormatGivesTheSameTrajectory) {
  const std::vector<Sweep> sweeps = sweeps_since_epoch();
  Odometry odometry({});
  std::vector<SE3> expected;
  for (const Sweep& sweep : sweeps) expected.push_back(odometry.register_sweep(sweep).T_odom_lidar);
  ASSERT_GT(expected.back().translation().norm(), 1.0);

  const TempDir folder;
  for (const char* name : {"pcd", "ply", "bin"}) fs::create_directory(folder / name);
  for (const Sweep& sweep : sweeps) {
    const std::string stamp = std::to_string(sweep.stamp_ns);
    write_pcd(folder / ("pcd/" + stamp + ".pcd"), sweep, PcdEncoding::kBinaryCompressed);
    write_ply(folder / ("ply/" + stamp + ".ply"), sweep);
    folder.write("bin/" + stamp + ".bin", bin_with_time(sweep));
  }
  SourceOptions with_time;
  with_time.bin_fields = "x,y,z,intensity,time";
  expect_equal(trajectory(folder / "pcd"), expected);
  expect_equal(trajectory(folder / "ply"), expected);
  expect_equal(trajectory(folder / "bin", with_time), expected);

  const auto ros2 = recorded(sweeps, MessageEncoding::kCdr);
  const Topics topics{{"/points", kRos2Type}};
  expect_equal(trajectory(folder.write("d.mcap", mcap_bytes(topics, ros2, {"zstd", 2, true}))), expected);
  write_db3(folder.write("rosbag2/d_0.db3", ""), topics, ros2);
  folder.write("rosbag2/metadata.yaml", metadata_yaml({"d_0.db3"}, "sqlite3"));
  expect_equal(trajectory(folder / "rosbag2"), expected);
#ifdef RILO_HAS_ROSBAG
  write_bag(folder / "d.bag", {{"/points", kRos1Type}}, recorded(sweeps, MessageEncoding::kRos1), "lz4");
  expect_equal(trajectory(folder / "d.bag"), expected);
#endif
}

}  // namespace
}  // namespace rilo::test
