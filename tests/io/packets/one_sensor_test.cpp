// Several sensors in one recording.
#include <algorithm>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

constexpr int kDrivePackets = 130;  // four turns and a bit of a Velodyne, two of an Ouster

std::string of_velodyne(int packet, int begin, std::uint8_t product = 0x22) {
  return velodyne_packet((begin + packet * 1200) % 36000, 100, 100 + static_cast<std::uint32_t>(packet) * 3333,
                         product);
}
std::int64_t at_ns(int packet) { return kCaptureBegin + packet * 3'333'000LL; }

void expect_sweeps_of_the_first(const Capture& both, const std::string& warning) {
  SCOPED_TRACE(warning);
  const TempDir folder;
  Capture alone;
  for (int i = 0; i < kDrivePackets; ++i) alone.udp(at_ns(i), 2368, of_velodyne(i, 9600));
  const auto expected = sweeps_of(*open_scan_source(folder.write("alone.pcap", alone.text())));
  const auto source = open_scan_source(folder.write("both.pcap", both.text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(expected.size(), 4U);
  ASSERT_EQ(sweeps.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(sweeps[i].points, expected[i].points);
  EXPECT_TRUE(has_warning(source->info(), warning));
}

TEST(OneSensorTest, TheFirstOneByAddressAndPort) {
  Capture address;
  Capture port;
  Capture product;
  for (int i = 0; i < kDrivePackets; ++i) {
    address.from(1).udp(at_ns(i), 2368, of_velodyne(i, 9600)).from(7).udp(at_ns(i), 2368, of_velodyne(i, 24000));
    port.udp(at_ns(i), 2368, of_velodyne(i, 9600)).udp(at_ns(i), 2369, of_velodyne(i, 24000));
    product.udp(at_ns(i), 2368, of_velodyne(i, 9600)).udp(at_ns(i), 2368, of_velodyne(i, 24000, 0x24));
  }
  expect_sweeps_of_the_first(address, "dropped 130 packets of another sensor, from 10.0.0.7 to port 2368");
  expect_sweeps_of_the_first(port, "dropped 130 packets of another sensor, from 10.0.0.1 to port 2369");
  expect_sweeps_of_the_first(product, "dropped 130 packets of another sensor, from 10.0.0.1 to port 2368");
}

// Their packets do not say whose they are.
TEST(OneSensorTest, TheFirstOneOfTwoOldOusters) {
  const TempDir folder;
  const OusterShape& legacy = kOusterShapes[0];
  folder.write("o.json", ouster_metadata(legacy));
  Capture both;
  for (std::size_t i = 0; i < 130; ++i) {
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    const std::int64_t at = kCaptureBegin + static_cast<std::int64_t>(ns);
    both.from(1).udp(at, 7502, ouster_packet(legacy, static_cast<std::uint16_t>(i / 64), i % 64 * 16, ns), 400);
    const std::size_t other = i + 20;
    both.from(2).udp(at, 7502, ouster_packet(legacy, static_cast<std::uint16_t>(other / 64), other % 64 * 16, ns), 400);
  }
  const auto source = open_scan_source(folder.write("o.pcap", both.text()));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].points.size(), 1024U * 3);
  EXPECT_EQ(sweeps[1].points.size(), 1024U * 3);
  EXPECT_TRUE(has_warning(source->info(), "dropped 130 packets of another sensor, from 10.0.0.2 to port 7502"));
}

// Not all that a recording has is named.
TEST(OneSensorTest, OfManySensorsSomeAreNamed) {
  const TempDir folder;
  Capture many;
  for (int i = 0; i < kDrivePackets; ++i) {
    for (char sender = 1; sender <= 12; ++sender) many.from(sender).udp(at_ns(i), 2368, of_velodyne(i, 9600));
  }
  const auto source = open_scan_source(folder.write("many.pcap", many.text()));
  EXPECT_EQ(sweeps_of(*source).size(), 4U);
  const SourceInfo info = source->info();
  const auto of_others = std::count_if(info.warnings.begin(), info.warnings.end(), [](const std::string& warning) {
    return warning.find("packets of another sensor, from") != std::string::npos;
  });
  EXPECT_EQ(of_others, 8);
  EXPECT_TRUE(has_warning(info, "dropped 390 packets of other sensors"));
}

}  // namespace
}  // namespace rilo::test
