// A capture in several files, and captures by other names.
#include "io/packets/captures.hpp"

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

constexpr int kPackets = 151;  // five turns of a VLP-16, and what shows that the last is whole

std::string part_of_drive(int begin, int end, std::int64_t later_ns = 0) {
  Capture capture;
  for (int i = begin; i < end; ++i) {
    const auto us = static_cast<std::uint32_t>(100 + i * 3333);
    capture.udp(kCaptureBegin + later_ns + i * 3'333'000LL, 2368,
                velodyne_packet((18000 + i * 1200) % 36000, 100, us, 0x22));
  }
  return capture.text();
}

std::vector<Sweep> sweeps_in(const std::filesystem::path& path) { return sweeps_of(*open_scan_source(path)); }

TEST(CapturesTest, ADriveInPartsIsTheDrive) {
  const TempDir folder;
  const auto whole = sweeps_in(folder.write("whole.pcap", part_of_drive(0, kPackets)));
  ASSERT_EQ(whole.size(), 5U);
  // Cut within turns; by their names the last part would come first.
  folder.write("parts/b", part_of_drive(0, 40));
  folder.write("parts/b1.pcap", part_of_drive(40, 101));
  folder.write("parts/a.cap", part_of_drive(101, kPackets));
  folder.write("parts/notes.txt", "rainy");
  const auto source = open_scan_source(folder / "parts");
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(sweeps[i].stamp_ns, whole[i].stamp_ns);
    EXPECT_EQ(sweeps[i].points, whole[i].points);
    EXPECT_EQ(sweeps[i].times_s, whole[i].times_s);
  }
  EXPECT_EQ(source->info().path, folder / "parts");
  ASSERT_EQ(source->info().warnings.size(), 1U);
  EXPECT_TRUE(has_warning(source->info(), "dropped 1 incomplete revolution at"));
}

TEST(CapturesTest, PartsThatCannotBeReadAreLeftOut) {
  const TempDir folder;
  folder.write("a.pcap", part_of_drive(0, kPackets));
  folder.write("b.pcap", "no capture at all, nothing of the kind");
  folder.write("c.pcap", Capture().text());
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(sweeps_of(*source).size(), 5U);
  EXPECT_TRUE(has_warning(source->info(), "b.pcap"));
  EXPECT_TRUE(has_warning(source->info(), "c.pcap, which has no UDP packets"));
  folder.write("a.pcap", "nor this");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"a.pcap", "libpcap"});
  folder.write("a.pcap", Capture().text());
  std::filesystem::remove(folder / "b.pcap");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"a.pcap", "no UDP packets"});
}

TEST(CapturesTest, APartThatIsCutOffIsNamed) {
  const TempDir folder;
  const std::string first = part_of_drive(0, 75);
  folder.write("a.pcap", first.substr(0, first.size() - 700));
  folder.write("b.pcap", part_of_drive(75, kPackets));
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(sweeps_of(*source).size(), 5U);
  EXPECT_TRUE(has_warning(source->info(), "a.pcap: the capture ends early"));
}

TEST(CapturesTest, TwoDrivesInOneFolderAreSaid) {
  const TempDir folder;
  folder.write("a.pcap", part_of_drive(0, kPackets));
  folder.write("b.pcap", part_of_drive(0, kPackets, 60'000'000'000));
  const auto source = open_scan_source(folder.path());
  sweeps_of(*source);
  EXPECT_TRUE(has_warning(source->info(), "b.pcap begins 59.5 s after a.pcap ends"));
}

TEST(CapturesTest, AreKnownByTheirFirstBytes) {
  const TempDir folder;
  const std::string bytes = part_of_drive(0, kPackets);
  for (const char* name : {"x", "x.pcap1", "x.cap", "x.2"}) {
    EXPECT_TRUE(detail::is_capture(folder.write(name, bytes))) << name;
    EXPECT_EQ(sweeps_in(folder / name).size(), 5U) << name;
  }
  EXPECT_TRUE(detail::is_capture(folder.write("ng", "\x0A\x0D\x0D\x0A")));
  EXPECT_FALSE(detail::is_capture(folder.write("x.bin", bytes)));
  EXPECT_FALSE(detail::is_capture(folder.write("x.bag", bytes)));
  EXPECT_FALSE(detail::is_capture(folder.write("text", "hello")));
  EXPECT_FALSE(detail::is_capture(folder.write("short", bytes.substr(0, 3))));
  EXPECT_FALSE(detail::is_capture(folder / "none"));
  EXPECT_FALSE(detail::is_capture(folder.path()));
}

// The folder of sweeps of which somebody kept the packets, too.
TEST(CapturesTest, BesideSweepsTheSweepsAreRead) {
  const TempDir folder;
  folder.write("0.bin", bytes_of<float>({1, 2, 3, 0, 4, 5, 6, 0}));
  folder.write("drive.pcap", part_of_drive(0, kPackets));
  EXPECT_EQ(open_scan_source(folder.path())->info().format, "bin");
}

}  // namespace
}  // namespace rilo::test
