// pcap recordings of Velodyne and Ouster sensors.
#include <cmath>
#include <numbers>
#include <random>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"
#include "io/packets/packet_decoder.hpp"
#include "io/packets/udp_reader.hpp"

namespace rilo {
namespace {

using test::Bytes;
using test::Capture;
using test::expect_io_error;
using test::has_warning;
using test::kOusterShapes;
using test::ouster_metadata;
using test::ouster_packet;
using test::OusterShape;
using test::sweeps_of;
using test::TempDir;
using test::velodyne_packet;

constexpr std::int64_t kCaptureBegin = 1'700'000'123'000'000'000;

// `turns` of a sensor of 10 Hz: packets of 12 blocks of 1°, 30 a turn, from `azimuth` on.
Capture velodyne_drive(std::uint8_t product, double turns, int azimuth = 9000, std::uint32_t hour_us = 100) {
  Capture capture;
  const auto packets = static_cast<int>(turns * 30);
  for (int i = 0; i < packets; ++i) {
    const std::uint32_t us = (hour_us + static_cast<std::uint32_t>(i) * 3333U) % 3'600'000'000U;
    capture.udp(kCaptureBegin + i * 3'333'000LL, 2368, velodyne_packet((azimuth + i * 1200) % 36000, 100, us, product));
    capture.udp(kCaptureBegin + i * 3'333'000LL, 8308, std::string(512, 'g'));  // its GPS
  }
  return capture;
}

double azimuth_deg(const Eigen::Vector3f& point) {
  return std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x())) * 180 / std::numbers::pi;
}
double elevation_deg(const Eigen::Vector3f& point) {
  return std::asin(static_cast<double>(point.z() / point.norm())) * 180 / std::numbers::pi;
}

TEST(VelodyneTest, TurnsFromTheRear) {
  const TempDir folder;
  const auto source = open_scan_source(folder.write("v.pcap", velodyne_drive(0x28, 4.5).text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 4U);  // begun at 90°: a quarter at the beginning and a quarter at the end are dropped
  for (const Sweep& sweep : sweeps) {
    EXPECT_EQ(sweep.points.size(), 360U * 32);
    EXPECT_EQ(sweep.times_s.front(), 0);
    EXPECT_NEAR(sweep.times_s.back(), 0.0999F, 1e-3F);
  }
  EXPECT_NEAR(static_cast<double>(sweeps[1].stamp_ns - sweeps[0].stamp_ns) * 1e-9, 0.09999, 1e-4);
  // The first laser of a turn looks behind: -25°, 1.4° farther on in the sense of the clock.
  EXPECT_NEAR(elevation_deg(sweeps[0].points[0]), -25, 1e-3);
  EXPECT_NEAR(azimuth_deg(sweeps[0].points[0]), 180 - 1.4, 1e-3);
  EXPECT_NEAR(sweeps[0].points[0].norm(), 20, 1e-4);  // 5000 of 4 mm
  EXPECT_EQ(sweeps[0].rings[0], 0);
  EXPECT_EQ(sweeps[0].rings[29], 31);  // 15°
  const SourceInfo info = source->info();
  EXPECT_EQ(info.kind, "packets");
  EXPECT_EQ(info.format, "Velodyne VLP-32C");
  EXPECT_NEAR(info.period_s, 0.1, 1e-3);
  EXPECT_TRUE(has_warning(info, "dropped 2 incomplete revolutions"));
  EXPECT_EQ(info.faults, StampFaults{});
}

TEST(VelodyneTest, SixteenLasersFireTwiceABlock) {
  const TempDir folder;
  const auto source = open_scan_source(folder.write("v.pcap", velodyne_drive(0x22, 3.5, 18000).text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 3U);
  const Sweep& sweep = sweeps[1];
  ASSERT_EQ(sweep.points.size(), 360U * 32);
  EXPECT_NEAR(std::abs(azimuth_deg(sweep.points[0])), 180, 0.01);
  EXPECT_NEAR(azimuth_deg(sweep.points[16]), 179.5, 0.01);  // half way to the next block
  EXPECT_NEAR(sweep.times_s[16], 55.296e-6, 1e-8);
  EXPECT_NEAR(sweep.times_s[17] - sweep.times_s[16], 2.304e-6, 1e-8);
  EXPECT_NEAR(sweep.points[0].z(),
              -10 * std::sin(15 * std::numbers::pi / 180) + 0.0112 * std::cos(15 * std::numbers::pi / 180), 1e-4);
  EXPECT_EQ(sweep.rings[15], 15);
}

TEST(VelodyneTest, OfTwoReturnsTheLast) {
  const TempDir folder;
  Capture capture;
  for (int i = 0; i < 150; ++i) {
    capture.udp(
        kCaptureBegin + i * 1'666'000LL, 2368,
        velodyne_packet((18000 + i * 600) % 36000, 100, static_cast<std::uint32_t>(i * 1666), 0x21, 5000, 0x39));
  }
  const auto source = open_scan_source(folder.write("v.pcap", capture.text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].points.size(), 360U * 32);
  for (const auto& point : sweeps[0].points) EXPECT_NEAR(point.norm(), 10, 1e-3);
  EXPECT_EQ(source->info().format, "Velodyne HDL-32E, of two returns the last");
}

std::string hdl64_calibration(int lasers) {
  std::string text = "num_lasers: 64\ndistance_resolution: 0.002\nlasers:\n";
  for (int i = 0; i < lasers; ++i) {
    text += "- {laser_id: " + std::to_string(i) + ", vert_correction: " + std::to_string(-0.4 + 0.007 * i) +
            ", rot_correction: " + std::to_string(0.01 * (i % 4)) + ", dist_correction: 1.0}\n";
  }
  return text;
}

TEST(VelodyneTest, TwoBanksNeedACalibration) {
  const TempDir folder;
  Capture capture;
  for (int i = 0; i < 200; ++i) {
    std::string packet = velodyne_packet((18000 + i * 1200) % 36000, 100, static_cast<std::uint32_t>(i * 3333), 0);
    for (std::size_t block = 1; block < 12; block += 2) {
      packet[block * 100 + 1] = '\xDD';
      packet[block * 100 + 2] = packet[block * 100 - 98];  // the same azimuth as the upper bank's
      packet[block * 100 + 3] = packet[block * 100 - 97];
    }
    capture.udp(kCaptureBegin + i * 3'333'000LL, 2368, packet);
  }
  const auto file = folder.write("h.pcap", capture.text());
  expect_io_error([&] { open_scan_source(file); }, {"h.pcap", "HDL-64E", "--sensor-file"});
  SourceOptions options;
  options.sensor_file = folder.write("64e.yaml", hdl64_calibration(64)).string();
  const auto sweeps = sweeps_of(*open_scan_source(file, options));
  ASSERT_GE(sweeps.size(), 5U);
  EXPECT_EQ(sweeps[1].points.size(), 180U * 64);
  EXPECT_NEAR(sweeps[1].points[0].norm(), 11, 1e-3);
  EXPECT_NEAR(azimuth_deg(sweeps[1].points[1]), 180 - (-0.01 * 180 / std::numbers::pi) - 360, 0.1);
  EXPECT_EQ(sweeps[1].rings[32], 32);  // the lower bank
  options.sensor_file = folder.write("32.yaml", hdl64_calibration(32)).string();
  expect_io_error([&] { open_scan_source(file, options); }, {"32.yaml", "32 lasers", "64 lasers"});
  options.sensor_file = folder.write("bad.yaml", "lasers: [").string();
  expect_io_error([&] { open_scan_source(file, options); }, {"bad.yaml"});
}

TEST(VelodyneTest, TheHourEnds) {
  const TempDir folder;
  const auto source = open_scan_source(folder.write("v.pcap", velodyne_drive(0x22, 6, 18000, 3'599'700'000U).text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_GE(sweeps.size(), 5U);
  for (std::size_t i = 1; i < sweeps.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(sweeps[i].stamp_ns - sweeps[i - 1].stamp_ns) * 1e-9, 0.1, 1e-3);
  }
  EXPECT_EQ(source->info().faults, StampFaults{});
}

TEST(PacketClockTest, TakesAClockThatIsRightAndSetsAnyOther) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  detail::PacketClock right(kHour);
  EXPECT_EQ(right.stamp_ns(kCaptureBegin % kHour - 400'000'000, kCaptureBegin), kCaptureBegin - 400'000'000);
  detail::PacketClock other(kHour);
  EXPECT_EQ(other.stamp_ns(5'000, kCaptureBegin), kCaptureBegin);
  EXPECT_EQ(other.stamp_ns(100'005'000, kCaptureBegin + 130'000'000),
            kCaptureBegin + 100'000'000);  // the recorder was late
  EXPECT_EQ(other.resets(), 0U);
  EXPECT_EQ(other.stamp_ns(900'000'000'000, kCaptureBegin + 200'000'000), kCaptureBegin + 200'000'000);
  EXPECT_EQ(other.resets(), 1U);
  detail::PacketClock absolute(0);
  EXPECT_EQ(absolute.stamp_ns(kCaptureBegin - 37, kCaptureBegin), kCaptureBegin - 37);
  EXPECT_EQ(absolute.stamp_ns(INT64_MAX, kCaptureBegin), kCaptureBegin);  // damaged: no overflow
}

// --- Ouster -------------------------------------------------------------------------------------------------------

Capture ouster_drive(const OusterShape& shape, std::size_t packets, std::size_t mtu = 65000) {
  Capture capture;
  for (std::size_t i = 0; i < packets; ++i) {
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7502,
                ouster_packet(shape, static_cast<std::uint16_t>(65535 + i / 64), i % 64 * 16, ns), mtu);
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7503, std::string(48, 'i'));
  }
  return capture;
}

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

// --- captures -----------------------------------------------------------------------------------------------------

std::size_t datagrams(const TempDir& folder, const std::string& bytes) {
  detail::UdpReader reader(folder.write("u.pcap", bytes));
  std::size_t count = 0;
  while (const auto datagram = reader.next()) {
    EXPECT_EQ(datagram->payload, "hello");
    EXPECT_EQ(datagram->port, 77);
    EXPECT_EQ(datagram->received_ns, 1'000'000'007);
    ++count;
  }
  return count;
}

TEST(UdpReaderTest, LinkTypesAndVlans) {
  const TempDir folder;
  constexpr std::int64_t kStamp = 1'000'000'007;
  Capture make;
  const std::string udp = Capture::big(1) + Capture::big(77) + Capture::big(13) + Capture::big(0) + "hello";
  const std::string ip = make.ipv4(udp, 0, false);
  EXPECT_EQ(datagrams(folder, Capture().udp(kStamp, 77, "hello").text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture().frame(kStamp, Capture::ethernet(ip, std::string("\x81\0\0\1", 4))).text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture(113).frame(kStamp, std::string(16, 's') + ip).text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture(276).frame(kStamp, std::string(20, 's') + ip).text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, ip).text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture(0).frame(kStamp, std::string(4, 'n') + ip).text()), 1U);
  std::string ip6 = std::string("\x60\0\0\0\0\x0D\x11\x40", 8) + std::string(32, 'a') + udp;
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, ip6).text()), 1U);
  // Other things than UDP, and lengths that are wrong.
  std::string tcp = ip;
  tcp[9] = 6;
  std::string longer = ip;
  longer[3] = 90;
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, tcp).frame(kStamp, longer).frame(kStamp, "").text()), 0U);
  expect_io_error([&] { datagrams(folder, Capture(147).text()); }, {"u.pcap", "link type 147"});
  expect_io_error([&] { datagrams(folder, "no capture at all, nothing of the kind"); }, {"u.pcap", "libpcap: "});
  expect_io_error([&] { open_scan_source(folder.write("e.pcap", Capture().text())); }, {"no packets"});
}

// One packet of a pcapng file whose clock counts whole seconds: 64 bits of them.
std::string capture_in_seconds(std::uint64_t seconds, std::string frame) {
  const auto captured = static_cast<std::uint32_t>(frame.size());
  frame.resize((frame.size() + 3) / 4 * 4);
  Bytes bytes;
  bytes.put(std::uint32_t{0x0A0D0D0A}).put(std::uint32_t{28}).put(std::uint32_t{0x1A2B3C4D}).put(std::uint32_t{1});
  bytes.put(std::int64_t{-1}).put(std::uint32_t{28});
  bytes.put(std::uint32_t{1}).put(std::uint32_t{32}).put(std::uint16_t{101}).put(std::uint16_t{0});
  bytes.put(std::uint32_t{65535}).put(std::uint16_t{9}).put(std::uint16_t{1}).put(std::uint32_t{0});  // 10^0
  bytes.put(std::uint32_t{0}).put(std::uint32_t{32});
  const auto length = static_cast<std::uint32_t>(32 + frame.size());
  bytes.put(std::uint32_t{6}).put(length).put(std::uint32_t{0}).put(static_cast<std::uint32_t>(seconds >> 32U));
  bytes.put(static_cast<std::uint32_t>(seconds)).put(captured).put(captured).raw(frame).put(length);
  return bytes.text;
}

TEST(UdpReaderTest, StampsThatDoNotFitSaturate) {
  const TempDir folder;
  const std::string udp = Capture::big(1) + Capture::big(77) + Capture::big(13) + Capture::big(0) + "hello";
  const std::string ip = Capture().ipv4(udp, 0, false);
  const auto stamp = [&](std::uint64_t seconds) {
    detail::UdpReader reader(folder.write("u.pcapng", capture_in_seconds(seconds, ip)));
    const auto datagram = reader.next();
    return datagram ? datagram->received_ns : -7;
  };
  EXPECT_EQ(stamp(1'700'000'000), 1'700'000'000'000'000'000);
  EXPECT_EQ(stamp(std::uint64_t{1} << 62U), INT64_MAX);
  EXPECT_EQ(stamp(std::uint64_t{1} << 63U), INT64_MIN);
}

TEST(UdpReaderTest, ACaptureThatIsCutOff) {
  const TempDir folder;
  const std::string whole = velodyne_drive(0x22, 3, 18000).text();
  const auto source = open_scan_source(folder.write("v.pcap", whole.substr(0, whole.size() - 700)));
  EXPECT_EQ(sweeps_of(*source).size(), 2U);
  EXPECT_TRUE(has_warning(source->info(), "the capture ends early"));
}

TEST(PacketSourceTest, HostileBytes) {
  std::mt19937 random(3);
  for (const bool velodyne : {true, false}) {
    const TempDir folder;
    folder.write("o.json", ouster_metadata(kOusterShapes[0]));
    const std::string whole =
        velodyne ? velodyne_drive(0x22, 2.5).text() : ouster_drive(kOusterShapes[0], 100, 400).text();
    for (int round = 0; round < 60; ++round) {
      const auto file = folder.write("o.pcap", test::damaged(whole, round, 5 * (round % 5), random));
      test::reads_or_refuses([&] {
        for (const Sweep& sweep : sweeps_of(*open_scan_source(file))) {
          EXPECT_EQ(sweep.times_s.size(), sweep.points.size());
        }
      });
    }
  }
}

TEST(PacketSourceTest, OusterMetadataTurnedOver) {
  std::mt19937 random(4);
  const TempDir folder;
  const auto file = folder.write("o.pcap", ouster_drive(kOusterShapes[1], 70).text());
  const std::string whole = ouster_metadata(kOusterShapes[1]);
  for (int round = 0; round < 300; ++round) {
    std::string json = whole;
    for (int k = 0; k < 1 + round % 3; ++k) json[random() % json.size()] = static_cast<char>(' ' + random() % 90);
    folder.write("o.json", json);
    test::reads_or_refuses([&] { sweeps_of(*open_scan_source(file)); });
  }
}

}  // namespace
}  // namespace rilo
