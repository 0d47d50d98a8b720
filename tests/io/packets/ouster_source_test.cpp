// pcap recordings of Ouster sensors.
#include <cmath>
#include <numbers>
#include <random>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

TEST(OusterTest, FramesOfEveryProfile) {
  for (const OusterShape& shape : kOusterShapes) {
    SCOPED_TRACE(shape.profile);
    const TempDir folder;
    folder.write("o.json", ouster_metadata(shape));
    const auto source = open_scan_source(folder.write("o.pcap", ouster_drive(shape, 200).text()));
    const auto sweeps = sweeps_of(*source);
    ASSERT_EQ(sweeps.size(), 3U);  // the 8 packets at the end are dropped
    for (const Sweep& sweep : sweeps) {
      ASSERT_EQ(sweep.points.size(), 1024U * 3);  // the lowest beam has no return
      EXPECT_NEAR(sweep.times_s.back(), 0.1F, 2e-4F);
    }
    EXPECT_EQ(sweeps[1].stamp_ns - sweeps[0].stamp_ns, 100'000'000);
    // Column 0 looks along -x of the LiDAR frame... which the sensor frame turns by 180°.
    const Eigen::Vector3f top = sweeps[0].points[0];
    const double across = 7.985 * std::cos(10 * std::numbers::pi / 180);
    EXPECT_NEAR(top.x(), -(across + 0.015), 1e-4);
    EXPECT_NEAR(top.y(), 0, 1e-4);
    EXPECT_NEAR(top.z(), 7.985 * std::sin(10 * std::numbers::pi / 180) + 0.03618, 1e-4);
    EXPECT_EQ(sweeps[0].rings[0], 3);
    EXPECT_EQ(sweeps[0].intensities[0], 7);
    // Beam 1 lies 1° farther on in the sense of the clock.
    EXPECT_NEAR(azimuth_deg(sweeps[0].points[1]), 179, 0.02);
    EXPECT_LT(azimuth_deg(sweeps[0].points[3 * 100]), 180 - 30.0);  // and so do later columns
    EXPECT_EQ(source->info().format.substr(0, 13), "Ouster OS-1-4");
  }
}

TEST(OusterTest, FragmentedPackets) {
  const TempDir folder;
  const OusterShape& shape = kOusterShapes[2];
  folder.write("o.json", ouster_metadata(shape));
  const auto whole = sweeps_of(*open_scan_source(folder.write("o.pcap", ouster_drive(shape, 130).text())));
  const auto parts = sweeps_of(*open_scan_source(folder.write("p.pcap", ouster_drive(shape, 130, 400).text())));
  ASSERT_EQ(whole.size(), 2U);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[1].points, whole[1].points);
}

TEST(OusterTest, MetadataThatDoNotFit) {
  const TempDir folder;
  const OusterShape& shape = kOusterShapes[2];
  const auto file = folder.write("o.pcap", ouster_drive(shape, 70).text());
  expect_io_error([&] { open_scan_source(file); },
                  {"o.pcap", "of 1024 bytes to port 7502", "no metadata of an Ouster", "--sensor-file"});
  const auto refused = [&](const std::string& json, std::initializer_list<std::string_view> parts) {
    SourceOptions options;
    options.sensor_file = folder.write("m.json", json).string();
    expect_io_error([&] { open_scan_source(file, options); }, parts);
  };
  refused("{", {"m.json", "not a JSON object"});
  refused("{}", {"m.json", "lidar_mode"});
  refused(R"({"lidar_mode": "1024x0"})", {"lidar_mode", "'1024x0'"});
  refused(R"({"lidar_mode": "1024x10"})", {"beam_altitude_angles"});
  refused(R"({"lidar_mode": "1024x10", "beam_altitude_angles": [1], "beam_azimuth_angles": []})", {"0 azimuths"});
  refused(R"({"lidar_mode": "1024x10", "beam_altitude_angles": ["a"], "beam_azimuth_angles": [1]})", {"not a number"});
  refused(R"({"lidar_mode": "1024x10", "data_format": {"udp_profile_lidar": "NEW"}})", {"'NEW'"});
  refused(ouster_metadata(kOusterShapes[0]), {"packets of 1088 bytes", "1024 bytes to port 7502"});
}

TEST(OusterTest, OfSeveralMetadataTheOneOfItsName) {
  const TempDir folder;
  const OusterShape& shape = kOusterShapes[2];
  const auto file = folder.write("drive_7_part.pcap", ouster_drive(shape, 70).text());
  const auto sweeps = [&] { return sweeps_of(*open_scan_source(file)).size(); };
  folder.write("digest.json", R"({"hashes": []})");  // other JSON does not count
  folder.write("a.json", ouster_metadata(shape));
  EXPECT_EQ(sweeps(), 1U);
  folder.write("b.json", ouster_metadata(kOusterShapes[0]));
  expect_io_error([&] { open_scan_source(file); },
                  {"2 metadata files", "does not say which: a.json, b.json", "--sensor-file"});
  folder.write("drive.json", ouster_metadata(kOusterShapes[1]));
  folder.write("drive_7.json", ouster_metadata(shape));  // the longer beginning of the recording's name
  EXPECT_EQ(sweeps(), 1U);
  folder.write("drive_7_part_metadata.json", ouster_metadata(kOusterShapes[0]));
  expect_io_error([&] { open_scan_source(file); }, {"as in", "drive_7_part_metadata.json"});
  folder.write("drive_7_part_0.json", ouster_metadata(shape));
  expect_io_error([&] { open_scan_source(file); }, {"6 metadata files", "does not say which"});
  folder.write("drive_7_part.json", ouster_metadata(shape));
  EXPECT_EQ(sweeps(), 1U);
}

TEST(OusterTest, MetadataTurnedOver) {
  std::mt19937 random(4);
  const TempDir folder;
  const auto file = folder.write("o.pcap", ouster_drive(kOusterShapes[1], 70).text());
  const std::string whole = ouster_metadata(kOusterShapes[1]);
  for (int round = 0; round < 300; ++round) {
    std::string json = whole;
    for (int k = 0; k < 1 + round % 3; ++k) json[random() % json.size()] = static_cast<char>(' ' + random() % 90);
    folder.write("o.json", json);
    reads_or_refuses([&] { sweeps_of(*open_scan_source(file)); });
  }
}

}  // namespace
}  // namespace rilo::test
