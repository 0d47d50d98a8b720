// pcap recordings of Velodyne sensors.
#include <cmath>
#include <numbers>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

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

// Azimuth times count from the forward direction, which a turn that begins behind faces half way.
TEST(VelodyneTest, TimesFromTheAzimuthAreTheSameTimes) {
  const TempDir folder;
  const auto file = folder.write("v.pcap", velodyne_drive(0x28, 4.5).text());
  SourceOptions options;
  const auto own = sweeps_of(*open_scan_source(file, options));
  options.point_times = PointTimes::kAzimuth;
  const auto azimuth = sweeps_of(*open_scan_source(file, options));
  ASSERT_EQ(azimuth.size(), own.size());
  const auto time_s = [](const Sweep& sweep, std::size_t i) {
    return 1e-9 * static_cast<double>(sweep.stamp_ns - kCaptureBegin) + static_cast<double>(sweep.times_s[i]);
  };
  for (std::size_t k = 0; k < own.size(); ++k) {
    for (std::size_t i = 0; i < own[k].points.size(); i += 100) {
      if (std::abs(azimuth_deg(own[k].points[i])) > 170) continue;        // of either end of the turn
      EXPECT_NEAR(time_s(azimuth[k], i), time_s(own[k], i), 0.003) << i;  // 4.2° aside
    }
  }
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

// Its four banks of 32 lasers have the flags of an HDL-64E's two among them.
TEST(VelodyneTest, FourBanksAreRefused) {
  constexpr std::string_view kBanks = "\xEE\xDD\xCC\xBB";
  std::string packet = velodyne_packet(18000, 0, 0, 0xA1);
  for (std::size_t block = 0; block < 12; ++block) packet[block * 100 + 1] = kBanks[block % 4];
  const TempDir folder;
  const auto file = folder.write("v.pcap", Capture().udp(kCaptureBegin, 2368, packet).text());
  SourceOptions options;
  for (const bool calibrated : {false, true}) {
    if (calibrated) options.sensor_file = folder.write("64e.yaml", hdl64_calibration(64)).string();
    expect_io_error([&] { open_scan_source(file, options); }, {"v.pcap", "VLS-128", "VLP-32C", "PointCloud2"});
  }
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

}  // namespace
}  // namespace rilo::test
