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

TEST(OusterTest, MetadataOfAnotherSensorAreRefused) {
  constexpr OusterIds kThis{122'201'000'998, 7'109'750};
  constexpr OusterIds kOther{122'150'000'150, 5'431'292};
  const TempDir folder;
  const OusterShape& shape = kOusterShapes[2];
  const auto file = folder.write("drive.pcap", ouster_drive(shape, 70, 65000, kThis).text());
  folder.write("other.json", ouster_metadata(shape, kOther));
  expect_io_error([&] { open_scan_source(file); },
                  {"drive.pcap", "122201000998", "122150000150", "other.json", "--sensor-file"});
  // Of several files that of the sensor, whatever they are called; then that of its start.
  folder.write("a.json", ouster_metadata(shape, {kThis.serial, 1}));
  const auto started_again = open_scan_source(file);
  EXPECT_EQ(sweeps_of(*started_again).size(), 1U);
  EXPECT_TRUE(has_warning(started_again->info(), "initialization_id 1 and 7109750"));
  folder.write("b.json", ouster_metadata(shape, kThis));
  const auto source = open_scan_source(file);
  EXPECT_EQ(sweeps_of(*source).size(), 1U);
  EXPECT_FALSE(has_warning(source->info(), "initialization_id"));
}

TEST(OusterTest, PacketsOfAnotherSensorAreNotMixedIn) {
  constexpr OusterIds kThis{1'000'000'000'001, 0};
  const TempDir folder;
  const OusterShape& shape = kOusterShapes[1];
  Capture both;
  for (std::size_t i = 0; i < 130; ++i) {
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    for (const OusterIds& ids : {OusterIds{7, 0}, kThis}) {
      both.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7502,
               ouster_packet(shape, static_cast<std::uint16_t>(i / 64 + ids.serial % 10), i % 64 * 16, ns, ids));
    }
  }
  folder.write("o.json", ouster_metadata(shape, kThis));
  const auto source = open_scan_source(folder.write("o.pcap", both.text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_TRUE(has_warning(source->info(), "dropped 130 packets of another sensor, from 10.0.0.1 to port 7502"));
  EXPECT_EQ(sweeps[0].points.size(), 1024U * 3);
}

TEST(OusterTest, DamagedMetadataAreNamedWithTheirReason) {
  const TempDir folder;
  const auto file = folder.write("o.pcap", ouster_drive(kOusterShapes[2], 70).text());
  folder.write("cut.json", ouster_metadata(kOusterShapes[2]).substr(0, 200));
  folder.write("empty.json", "{}");
  expect_io_error([&] { open_scan_source(file); },
                  {"o.pcap", "cut.json: text that is not a JSON object", "empty.json: lidar_mode: no such key"});
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
