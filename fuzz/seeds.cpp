// A few small good files for each harness: fuzz_seeds DIR writes DIR/NAME/*.
#include <fstream>
#include <iostream>
#include <sqlite3.h>
#include <stdexcept>

#include "harness.hpp"
#include "io/packets/packet_bytes.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/sweep_writer.hpp"

namespace rilo::fuzz {
namespace {

namespace fs = std::filesystem;

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  fs::path file(const std::string& harness, const std::string& name) const {
    fs::create_directories(folder_ / harness);
    return folder_ / harness / name;
  }
  void write(const std::string& harness, const std::string& name, std::string_view bytes) const {
    std::ofstream(file(harness, name), std::ios::binary) << bytes;
  }

 private:
  fs::path folder_;
};

void clouds(const Seeds& seeds, const Sweep& sweep) {
  write_kitti_bin(seeds.file("bin", "plain"), sweep);
  write_pcd(seeds.file("pcd", "ascii"), sweep, PcdEncoding::kAscii);
  write_pcd(seeds.file("pcd", "binary"), sweep, PcdEncoding::kBinary);
  write_pcd(seeds.file("pcd", "compressed"), sweep, PcdEncoding::kBinaryCompressed);
  write_ply(seeds.file("ply", "ascii"), sweep, PlyEncoding::kAscii);
  write_ply(seeds.file("ply", "little"), sweep, PlyEncoding::kBinaryLittleEndian);
  write_ply(seeds.file("ply", "big"), sweep, PlyEncoding::kBinaryBigEndian);
}

void messages(const Seeds& seeds, const std::vector<Sweep>& sweeps) {
  const std::string ros1 = test::message_bytes(test::message_of(sweeps[0]), MessageEncoding::kRos1);
  const std::string ros2 = test::message_bytes(test::message_of(sweeps[0]), MessageEncoding::kCdr);
  seeds.write("point_cloud2", "ros1", '\0' + ros1);
  seeds.write("point_cloud2", "cdr", '\3' + ros2);
}

// Small pages: what is longer than the harnesses' inputs may be would be cut off.
void make_small(const fs::path& file) {
  sqlite3* database = nullptr;
  const bool done = sqlite3_open(file.c_str(), &database) == SQLITE_OK &&
                    sqlite3_exec(database, "PRAGMA page_size = 512; VACUUM", nullptr, nullptr, nullptr) == SQLITE_OK;
  sqlite3_close(database);
  if (!done) throw std::runtime_error(file.string());
}

void recordings(const Seeds& seeds, const std::vector<Sweep>& sweeps) {
  const test::Topics topics{{"/points", test::kRos2Type}};
  const auto ros2 = test::recorded(sweeps, MessageEncoding::kCdr);
  seeds.write("mcap", "plain", test::mcap_bytes(topics, ros2, {}));
  seeds.write("mcap", "zstd", test::mcap_bytes(topics, ros2, {"zstd", 1}));
  seeds.write("mcap", "lz4", test::mcap_bytes(topics, ros2, {"lz4", 2, false}));
  seeds.write("mcap", "loose", test::mcap_bytes(topics, ros2, {"", 0}));
  const fs::path database = seeds.file("rosbag2", "database");
  test::write_db3(database, topics, ros2);
  make_small(database);
  std::ifstream stream(database, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  fs::remove(database);
  seeds.write("rosbag2", "plain", test::metadata_yaml({"a.db3"}, "sqlite3") + '\0' + bytes);
  seeds.write("rosbag2", "packed",
              test::metadata_yaml({"a.db3.zstd"}, "sqlite3", "FILE") + '\0' + test::zstd_of(bytes));
}

// Two frames of 16 valid columns of 2 pixels.
std::string ouster_packets(std::string_view profile) {
  const bool legacy = profile == "LEGACY";
  const std::size_t pixel = legacy || profile == "RNG19_RFL8_SIG16_NIR16" ? 12 : profile == "RNG15_RFL8_NIR8" ? 4 : 16;
  test::Bytes bytes;
  for (std::uint16_t column = 0; column < 32; ++column) {
    const auto frame = static_cast<std::uint16_t>(column / 16);
    if (!legacy && column % 2 == 0) bytes.put(std::uint16_t{1}).put(frame).raw(std::string(28, '\0'));
    bytes.put(std::uint64_t{column} * 6'250'000).put(static_cast<std::uint16_t>(column % 16));
    if (legacy) bytes.put(frame).put(std::uint32_t{0});
    if (!legacy) bytes.put(std::uint16_t{1});
    bytes.raw(std::string(2 * pixel, '\1'));
    if (legacy) bytes.put(~std::uint32_t{0});
    if (!legacy && column % 2 == 1) bytes.raw(std::string(32, '\0'));
  }
  return bytes.text;
}

void packets(const Seeds& seeds) {
  for (const int product : {0x21, 0x22, 0x28}) {
    test::Capture capture;
    for (int i = 0; i < 4; ++i) {
      capture.udp(i * 3'333'000LL, 2368,
                  test::velodyne_packet(i * 12000 % 36000, 1000, static_cast<std::uint32_t>(i) * 3333,
                                        static_cast<std::uint8_t>(product)),
                  i == 3 ? 800 : 65000);
    }
    seeds.write("pcap", "velodyne" + std::to_string(product), capture.text());
  }
  for (const char* profile : {"LEGACY", "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL"}) {
    const std::string metadata = R"({"lidar_mode": "16x10", "beam_altitude_angles": [10, 0], "beam_azimuth_angles": [0,
      1], "data_format": {"columns_per_packet": 2, "column_window": [0, 15], "udp_profile_lidar": ")" +
                                 std::string(profile) + "\"}}";
    seeds.write("ouster", profile, metadata + '\0' + ouster_packets(profile));
  }
}

void texts(const Seeds& seeds) {
  seeds.write("poses", "kitti", "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 4 0 1 0 5 0 0 1 6\n");
  seeds.write("poses", "tum", "1.5 1 2 3 0 0 0 1\n# so\n1.6 1 2 3 0 0 0 1\n");
  seeds.write("poses", "stamps", "0.0\n1.0e-01\n2.0e-01\n");
  seeds.write("poses", "calibration", "P0: 1 2\nTr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
}

}  // namespace
}  // namespace rilo::fuzz

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "fuzz_seeds DIR\n";
    return 2;
  }
  const rilo::fuzz::Seeds seeds(arguments[1]);
  const auto sweeps = rilo::test::numbered_sweeps(2, 6);
  rilo::fuzz::clouds(seeds, sweeps[0]);
  rilo::fuzz::messages(seeds, sweeps);
  rilo::fuzz::recordings(seeds, sweeps);
  rilo::fuzz::packets(seeds);
  rilo::fuzz::texts(seeds);
  return 0;
}
