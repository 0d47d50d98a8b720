// Recordings of real sensors and what other programs made of them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sqlite3.h>

#include "io/io_test_util.hpp"
#include "io/packets/velodyne.hpp"
#include "io/real_files.hpp"
#include "rilo/io/point_cloud2.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

// The packets of a VelodyneScan in CDR: stamp and 1206 bytes each.
struct ScanPacket {
  std::int64_t stamp_ns = 0;
  std::string bytes;
};
std::vector<ScanPacket> packets_of(std::string_view message) {
  const auto get = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, message.data() + at, 4);
    return value;
  };
  std::size_t at = 16 + get(12);
  at = (at + 3) / 4 * 4;
  std::vector<ScanPacket> packets(get(at));
  at += 4;
  for (ScanPacket& packet : packets) {
    packet.stamp_ns = std::int64_t{get(at)} * 1'000'000'000 + get(at + 4);
    packet.bytes = std::string(message.substr(at + 8, detail::kVelodynePacket));
    at += 8 + 1208;  // padded to four bytes
  }
  return packets;
}

std::vector<ScanPacket> packets_in(const fs::path& file) {
  sqlite3* database = nullptr;
  sqlite3_stmt* rows = nullptr;
  sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
  sqlite3_prepare_v2(database, "SELECT data FROM messages ORDER BY timestamp", -1, &rows, nullptr);
  std::vector<ScanPacket> all;
  while (sqlite3_step(rows) == SQLITE_ROW) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(rows, 0));
    for (auto& packet : packets_of({data, static_cast<std::size_t>(sqlite3_column_bytes(rows, 0))})) {
      all.push_back(std::move(packet));
    }
  }
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return all;
}

// Nebula cuts turns elsewhere: each of its points must be among ours.
void expect_points_of(const fs::path& truth_file, const fs::path& recording, double tolerance_m) {
  const RawCloud truth = read_pcd(truth_file);
  const auto packets = packets_in(recording);
  const auto decoder = detail::velodyne_decoder(detail::velodyne_model(packets.at(0).bytes, recording, ""));
  std::deque<detail::DecodedSweep> sweeps;
  for (const ScanPacket& packet : packets) {
    ASSERT_TRUE(decoder->accepts(packet.bytes));
    decoder->take(packet.bytes, packet.stamp_ns, sweeps);
  }
  decoder->finish(sweeps);
  std::vector<Eigen::Vector3f> points;
  for (const auto& done : sweeps) points.insert(points.end(), done.sweep.points.begin(), done.sweep.points.end());
  std::size_t near = 0;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < truth.points.size(); i += 97, ++looked_at) {
    float least = 1e9F;
    for (const auto& point : points) least = std::min(least, (point - truth.points[i]).squaredNorm());
    near += std::sqrt(least) < tolerance_m ? 1 : 0;
  }
  EXPECT_GT(near, looked_at * 98 / 100) << "of " << looked_at << " points of " << decoder->description();
}

TEST_F(RealFiles, Vlp16AsNebulaDecodesIt) {
  expect_points_of(file("db3/velodyne_vlp16/1673400472138016708.pcd"),
                   file("db3/velodyne_vlp16/1673400471837873222_0.db3"), 0.02);
}

TEST_F(RealFiles, Vlp32AsNebulaDecodesIt) {
  expect_points_of(file("db3/velodyne_vlp32/1713492677464078412.pcd"),
                   file("db3/velodyne_vlp32/1713492677464078412_0.db3"), 0.03);
}

// A few turns at 10 Hz; the sensors stood still or moved slowly.
void expect_turns(ScanSource& source, std::size_t turns, const std::string& format, double sweep_s) {
  const auto sweeps = sweeps_of(source);
  EXPECT_EQ(source.info().format, format);
  ASSERT_EQ(sweeps.size(), turns);
  for (const Sweep& sweep : sweeps) {
    EXPECT_GT(sweep.points.size(), 5000U);
    EXPECT_NEAR(*std::max_element(sweep.times_s.begin(), sweep.times_s.end()), sweep_s, 0.1 * sweep_s);
  }
  Odometry odometry({});
  for (const Sweep& sweep : sweeps) EXPECT_LT(odometry.register_sweep(sweep).T_odom_lidar.translation().norm(), 3.0);
}

TEST_F(RealFiles, VelodyneCaptures) {
  const auto vlp16 = open_scan_source(file("pcap/velodyne_vlp16_gps.pcap"));
  expect_turns(*vlp16, 3, "Velodyne VLP-16", 0.1);
  const auto hdl32 = open_scan_source(file("pcap/velodyne_hdl32.pcap"));
  expect_turns(*hdl32, 1, "Velodyne HDL-32E", 0.11);
}

TEST_F(RealFiles, OusterCaptures) {
  const auto low = open_scan_source(file("pcap/ouster/OS-0-128-U1_v2.3.0_1024x10.pcap"));
  expect_turns(*low, 1, "Ouster OS-0-128, RNG15_RFL8_NIR8", 0.1);
  const auto dual = open_scan_source(file("pcap/ouster/OS-0-32-U1_v2.2.0_1024x10.pcap"));
  expect_turns(*dual, 1, "Ouster OS-0-32-U1, RNG19_RFL8_SIG16_NIR16_DUAL, the first of two returns", 0.1);
  SourceOptions options;
  options.sensor_file = file("pcap/ouster/OS-1-64_sensor_config_reduced.json").string();
  const auto legacy = open_scan_source(file("pcap/ouster/OS-1-64_1024x10_fw20.pcap"), options);
  expect_turns(*legacy, 1, "Ouster, LEGACY", 0.1);
}

// Three sweeps of a moving sensor, beside the poses that Ouster's own tool found.
TEST_F(RealFiles, OusterPoses) {
  SourceOptions options;
  options.sensor_file = file("pcap/ouster/OS-1-128_v2.3.0_1024x10.json").string();
  const auto sweeps = sweeps_of(*open_scan_source(file("pcap/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"), options));
  ASSERT_EQ(sweeps.size(), 3U);
  Odometry odometry({});
  SE3 pose = SE3::Identity();
  for (const Sweep& sweep : sweeps) pose = odometry.register_sweep(sweep).T_odom_lidar;
  EXPECT_NEAR(pose.translation().x(), 0.498, 0.05);
  EXPECT_NEAR(pose.translation().y(), 0.006, 0.05);
  EXPECT_NEAR(pose.translation().z(), -0.001, 0.05);
}

// Recordings of the drivers' packets: the same sensors as Nebula's clouds above, and a bag of Ouster's own.
TEST_F(RealFiles, PacketsInRecordings) {
  const auto vlp16 = open_scan_source(file("db3/velodyne_vlp16"));
  expect_turns(*vlp16, 3, "rosbag2 (sqlite3), Velodyne VLP-16, of two returns the last", 0.1);
  EXPECT_EQ(vlp16->info().topic, "/velodyne_packets");
  const auto vlp32 = open_scan_source(file("db3/velodyne_vlp32/1713492677464078412_0.db3"));
  expect_turns(*vlp32, 4, "rosbag2 (sqlite3), Velodyne VLP-32C", 0.05);  // it sends 180° of the turn
#ifdef RILO_HAS_ROSBAG
  const auto ouster = open_scan_source(file("bag1/ouster_512x10_raw_packets.bag"));
  expect_turns(*ouster, 1, "ROS 1 bag, Ouster OS-0-128, RNG15_RFL8_NIR8", 0.1);
  EXPECT_EQ(ouster->info().topic, "/os_node0/lidar_packets");
#endif
}

// Of six .json beside it the one whose name begins the recording's.
TEST_F(RealFiles, OusterMetadataByName) {
  const auto source = open_scan_source(file("pcap/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"));
  EXPECT_EQ(sweeps_of(*source).size(), 3U);
  expect_io_error([] { open_scan_source(file("pcap/ouster/OS-1-64_1024x10_fw20.pcap")); },
                  {"metadata files of an Ouster beside it", "OS-1-64_sensor_config_reduced.json"});
}

TEST_F(RealFiles, APointCloud2InCdr) {
  const std::string bytes = slurp(file("cdr/cloudini_pointcloud2_dds_message.bin"));
  const PointCloud2 message = parse_point_cloud2(bytes, MessageEncoding::kCdr, "dds_message.bin");
  const RawCloud cloud = columns_of(message, "", "dds_message.bin");
  EXPECT_EQ(cloud.points.size(), std::size_t{message.width} * message.height);
  std::size_t near = 0;
  for (const auto& point : cloud.points) near += point.allFinite() && point.norm() < 300 ? 1 : 0;
  EXPECT_GT(near, cloud.points.size() / 2);
}

}  // namespace
}  // namespace rilo::test
