// Captures of packets, whatever the sensor: link types, clocks, damage.
#include <random>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"
#include "io/packets/packet_decoder.hpp"
#include "io/packets/udp_reader.hpp"

namespace rilo::test {
namespace {

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

// Fragments of three datagrams, of which two have the same number and two the same sender, and one the wrong way round.
TEST(UdpReaderTest, FragmentsAreThoseOfOneSenderAndNumber) {
  const TempDir folder;
  constexpr std::int64_t kStamp = 1'000'000'007;
  const std::string udp = Capture::big(1) + Capture::big(77) + Capture::big(13) + Capture::big(0) + "hello";
  const Capture make;
  const std::string first = make.ipv4(udp.substr(0, 8), 0, true);
  const std::string last = make.ipv4(udp.substr(8), 8, false);
  const auto changed = [](std::string packet, std::size_t at) {
    packet[at] = 9;
    return packet;
  };
  Capture capture(101);
  for (const std::string& part : {first, last}) {
    capture.frame(kStamp, part).frame(kStamp, changed(part, 5)).frame(kStamp, changed(part, 15));
  }
  EXPECT_EQ(datagrams(folder, capture.text()), 3U);
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, last).frame(kStamp, first).text()), 1U);
}

// A datagram in two fragments, of which the first has the header alone.
struct TwoFragments {
  explicit TwoFragments(std::string_view text = "hello") {
    const auto length = static_cast<std::uint16_t>(8 + text.size());
    const std::string udp = Capture::big(1) + Capture::big(77) + Capture::big(length) + Capture::big(0);
    first = Capture().ipv4(udp, 0, true);
    last = Capture().ipv4(text, 8, false);
  }
  std::string first;
  std::string last;
};

// Senders number their datagrams with 16 bits, which come again.
TEST(UdpReaderTest, FragmentsOfALostDatagramAreForgotten) {
  const TempDir folder;
  constexpr std::int64_t kStamp = 1'000'000'007;
  constexpr std::int64_t kLong = 1'100'000'000;
  const TwoFragments now;
  const TwoFragments before("HELLO");
  Capture late(101);
  late.frame(kStamp - kLong, before.last).frame(kStamp, now.first).frame(kStamp, now.last);
  EXPECT_EQ(datagrams(folder, late.text()), 1U);
  // A clock that is set back does not keep them, either.
  Capture back(101);
  back.frame(kStamp + kLong, before.last).frame(kStamp, now.first).frame(kStamp, now.last);
  EXPECT_EQ(datagrams(folder, back.text()), 1U);
}

TEST(UdpReaderTest, AFragmentThatComesTwiceCountsOnce) {
  const TempDir folder;
  constexpr std::int64_t kStamp = 1'000'000'007;
  const TwoFragments now;
  const TwoFragments before("HELLO");
  Capture twice(101);
  twice.frame(kStamp, now.last).frame(kStamp, now.last).frame(kStamp, now.last).frame(kStamp, now.first);
  EXPECT_EQ(datagrams(folder, twice.text()), 1U);
  // Other bytes in the same place are of another datagram, of a sender that gives all the same number.
  Capture same_number(101);
  same_number.frame(kStamp, before.last).frame(kStamp, before.last).frame(kStamp, now.last).frame(kStamp, now.first);
  EXPECT_EQ(datagrams(folder, same_number.text()), 1U);
}

TEST(UdpReaderTest, LengthsAreThoseOfTheHeaders) {
  const TempDir folder;
  constexpr std::int64_t kStamp = 1'000'000'007;
  const std::string udp = Capture::big(1) + Capture::big(77) + Capture::big(13) + Capture::big(0) + "hello";
  const Capture make;
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, make.ipv4(udp + "more", 0, false)).text()), 1U);
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, make.ipv4(udp.substr(0, 12), 0, false)).text()), 0U);
  std::string options = make.ipv4("abcd" + udp, 0, false);  // four bytes of options in the header
  options[0] = '\x46';
  EXPECT_EQ(datagrams(folder, Capture(101).frame(kStamp, options).text()), 1U);
  // A frame of which the recorder kept a part.
  std::string cut = Capture(101).frame(kStamp, make.ipv4(udp, 0, false)).text();
  cut[24 + 12] = 100;
  detail::UdpReader reader(folder.write("cut.pcap", cut));
  EXPECT_FALSE(reader.next());
  ASSERT_EQ(reader.warnings().size(), 1U);
  EXPECT_NE(reader.warnings()[0].find("1 packet recorded in part"), std::string::npos);
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
  // From there at its own rate again.
  EXPECT_EQ(other.stamp_ns(900'100'000'000, kCaptureBegin + 320'000'000), kCaptureBegin + 300'000'000);
  detail::PacketClock absolute(0);
  EXPECT_EQ(absolute.stamp_ns(kCaptureBegin - 37, kCaptureBegin), kCaptureBegin - 37);
  EXPECT_EQ(absolute.stamp_ns(INT64_MAX, kCaptureBegin), kCaptureBegin);  // damaged: no overflow
}

// The hour of the sensor may end before or after that of the recorder, whatever the sign.
TEST(PacketClockTest, TheHourIsTheNearest) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  constexpr std::int64_t kLittle = 100'000'000;
  for (const std::int64_t hours : {-3, 0, 1, 7}) {
    EXPECT_EQ(detail::PacketClock(kHour).stamp_ns(kLittle, hours * kHour - kLittle), hours * kHour + kLittle);
    EXPECT_EQ(detail::PacketClock(kHour).stamp_ns(kHour - kLittle, hours * kHour + kLittle), hours * kHour - kLittle);
  }
}

TEST(PacketClockTest, AClockThatGoesASecondApartIsSet) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  detail::PacketClock clock(0);
  EXPECT_EQ(clock.stamp_ns(kCaptureBegin - kSecond, kCaptureBegin), kCaptureBegin - kSecond);
  EXPECT_EQ(clock.resets(), 0U);
  EXPECT_EQ(clock.stamp_ns(kCaptureBegin - kSecond - 1, kCaptureBegin), kCaptureBegin);
  EXPECT_EQ(clock.resets(), 1U);
}

// Half a revolution is dropped at the ends of a recording, not where it is all there is, nor where packets were lost.
TEST(PacketSourceTest, AnIncompleteRevolutionIsDroppedAtTheEndsOnly) {
  const TempDir folder;
  const auto alone = open_scan_source(folder.write("half.pcap", velodyne_drive(0x22, 0.5, 20000).text()));
  EXPECT_EQ(sweeps_of(*alone).size(), 1U);
  Capture capture;
  for (std::size_t i = 0; i < 5 * 64 + 32; ++i) {
    if (i >= 3 * 64 && i < 3 * 64 + 32) continue;
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7502,
                ouster_packet(kOusterShapes[0], static_cast<std::uint16_t>(i / 64), i % 64 * 16, ns));
  }
  folder.write("lost.json", ouster_metadata(kOusterShapes[0]));
  const auto lost = open_scan_source(folder.write("lost.pcap", capture.text()));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(lost->next()->points.size(), (i == 3 ? 512U : 1024U) * 3);
    EXPECT_EQ(lost->current_index(), i);
  }
  EXPECT_FALSE(lost->next());
  EXPECT_TRUE(has_warning(lost->info(), "dropped 1 incomplete revolution at"));
}

TEST(PacketSourceTest, HostileBytes) {
  std::mt19937 random(3);
  for (const bool velodyne : {true, false}) {
    const TempDir folder;
    folder.write("o.json", ouster_metadata(kOusterShapes[0]));
    const std::string whole =
        velodyne ? velodyne_drive(0x22, 2.5).text() : ouster_drive(kOusterShapes[0], 100, 400).text();
    for (int round = 0; round < 60; ++round) {
      const auto file = folder.write("o.pcap", damaged(whole, round, 5 * (round % 5), random));
      reads_or_refuses([&] {
        for (const Sweep& sweep : sweeps_of(*open_scan_source(file))) {
          EXPECT_EQ(sweep.times_s.size(), sweep.points.size());
        }
      });
    }
  }
}

}  // namespace
}  // namespace rilo::test
