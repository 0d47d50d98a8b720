// Packets that come twice, too late or in another order.
#include "io/packets/packet_order.hpp"

#include <algorithm>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

using Arrival = detail::PacketOrder::Arrival;
constexpr std::int64_t kMs = 1'000'000;

TEST(PacketOrderTest, APacketIsNextLateOrDropped) {
  constexpr std::int64_t kHour = 3'600'000 * kMs;
  detail::PacketOrder order(kHour);
  const auto arrival = [&](std::int64_t sensor_ms, std::uint64_t place = 0) {
    return order.arrival(sensor_ms * kMs % kHour, place);
  };
  constexpr std::int64_t kBegin = 3'599'998;  // the hour ends soon
  EXPECT_EQ(arrival(kBegin), Arrival::kNext);
  EXPECT_EQ(arrival(kBegin), Arrival::kDropped);
  EXPECT_EQ(arrival(kBegin, 1), Arrival::kNext);  // a clock that stands still
  EXPECT_EQ(arrival(kBegin + 4), Arrival::kNext);
  EXPECT_EQ(arrival(kBegin + 1), Arrival::kLate);
  EXPECT_EQ(arrival(kBegin + 3), Arrival::kLate);
  EXPECT_EQ(arrival(kBegin + 3), Arrival::kDropped);
  EXPECT_EQ(arrival(kBegin - 1), Arrival::kDropped);
  EXPECT_EQ(arrival(kBegin + 5), Arrival::kNext);
  order.begin_sweep();
  EXPECT_EQ(arrival(kBegin + 2), Arrival::kDropped);
  EXPECT_EQ(arrival(kBegin + 5), Arrival::kDropped);
  EXPECT_EQ(arrival(kBegin + 7), Arrival::kNext);
  EXPECT_EQ(arrival(kBegin + 6), Arrival::kLate);
  EXPECT_EQ(order.dropped(), 5U);
}

TEST(PacketOrderTest, AClockThatIsSetBeginsAnotherOrder) {
  detail::PacketOrder order(0);
  EXPECT_EQ(order.arrival(5000 * kMs, 0), Arrival::kNext);
  EXPECT_EQ(order.arrival(4000 * kMs, 0), Arrival::kDropped);
  EXPECT_EQ(order.arrival(4000 * kMs - 1, 0), Arrival::kNext);
  EXPECT_EQ(order.arrival(INT64_MAX, 0), Arrival::kNext);
  EXPECT_EQ(order.arrival(3000 * kMs, 0), Arrival::kNext);
  EXPECT_EQ(order.arrival(2999 * kMs, 0), Arrival::kDropped);
}

struct SensorCase {
  std::string name;
  std::int64_t step_ns;
  std::size_t border;  // the packet in which the third sweep begins
  std::vector<std::string> packets;
};

// Three sweeps and a bit, from a time of the sensor's clock on. The Velodyne's begin in the middle of a packet.
SensorCase velodyne_case(double begin_s) {
  SensorCase velodyne{"Velodyne", 3'333'000, 67, {}};
  for (int i = 0; i < 115; ++i) {
    velodyne.packets.push_back(velodyne_packet((9000 + 600 + i * 1200) % 36000, 100,
                                               static_cast<std::uint32_t>(begin_s * 1e6 + i * 3333), 0x22));
  }
  return velodyne;
}
SensorCase ouster_case(double begin_s, const OusterShape& shape) {
  SensorCase ouster{shape.profile, 1'562'500, 128, {}};
  for (std::size_t i = 0; i < 200; ++i) {
    ouster.packets.push_back(ouster_packet(shape, static_cast<std::uint16_t>(65534 + i / 64), i % 64 * 16,
                                           static_cast<std::uint64_t>(begin_s * 1e9) + i * 1'562'500));
  }
  return ouster;
}
std::vector<SensorCase> sensor_cases(double begin_s = 10) {
  return {velodyne_case(begin_s), ouster_case(begin_s, kOusterShapes[0]), ouster_case(begin_s, kOusterShapes[1])};
}

struct Read {
  std::vector<Sweep> sweeps;
  SourceInfo info;
};

// The packets come evenly.
Read read_packets(const SensorCase& sensor, const std::vector<std::string>& packets) {
  const TempDir folder;
  folder.write("c.json", ouster_metadata(kOusterShapes[sensor.name == "LEGACY" ? 0 : 1]));
  Capture capture;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(i) * sensor.step_ns, 2368, packets[i]);
  }
  const auto source = open_scan_source(folder.write("c.pcap", capture.text()));
  std::vector<Sweep> sweeps = sweeps_of(*source);
  return {std::move(sweeps), source->info()};
}

std::size_t points_in(const std::vector<Sweep>& sweeps) {
  std::size_t count = 0;
  for (const Sweep& sweep : sweeps) count += sweep.points.size();
  return count;
}

TEST(PacketOrderTest, PacketsThatComeTwiceChangeNothing) {
  for (const SensorCase& sensor : sensor_cases()) {
    SCOPED_TRACE(sensor.name);
    const Read once = read_packets(sensor, sensor.packets);
    ASSERT_EQ(once.sweeps.size(), 3U);
    EXPECT_FALSE(has_warning(once.info, "came twice"));
    std::vector<std::string> all_twice;
    for (const std::string& packet : sensor.packets) all_twice.insert(all_twice.end(), 2, packet);
    std::vector<std::vector<std::string>> cases{all_twice};
    for (const std::size_t packet : {sensor.border - 10, sensor.border - 1, sensor.border}) {
      for (const std::size_t later : {1U, 2U, 5U}) {
        cases.push_back(sensor.packets);
        cases.back().insert(cases.back().begin() + static_cast<std::ptrdiff_t>(packet + later), sensor.packets[packet]);
      }
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
      SCOPED_TRACE(i);
      const Read twice = read_packets(sensor, cases[i]);
      ASSERT_EQ(twice.sweeps.size(), 3U);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(twice.sweeps[k].points, once.sweeps[k].points);
      const std::size_t dropped = cases[i].size() - sensor.packets.size();
      EXPECT_TRUE(has_warning(twice.info, "dropped " + std::to_string(dropped) + " packet"));
      EXPECT_TRUE(has_warning(twice.info, "came twice or too late"));
    }
  }
}

// Within a sweep nothing is lost, at its border a packet.
TEST(PacketOrderTest, PacketsInAnotherOrderBeginNoSweep) {
  for (const SensorCase& sensor : sensor_cases()) {
    SCOPED_TRACE(sensor.name);
    const Read in_order = read_packets(sensor, sensor.packets);
    const std::size_t of_packet = sensor.name == "Velodyne" ? 12U * 32 : 16U * 3;
    for (const std::size_t packet : {sensor.border - 10, sensor.border - 1, sensor.border, sensor.border + 1}) {
      SCOPED_TRACE(packet);
      std::vector<std::string> packets = sensor.packets;
      std::swap(packets[packet], packets[packet + 1]);
      const Read swapped = read_packets(sensor, packets);
      ASSERT_EQ(swapped.sweeps.size(), 3U);
      const std::size_t lost = points_in(in_order.sweeps) - points_in(swapped.sweeps);
      EXPECT_EQ(lost, packet < sensor.border - 1 || packet > sensor.border ? 0U : of_packet);
      EXPECT_EQ(has_warning(swapped.info, "dropped 1 packet that came twice or too late"), lost > 0);
    }
  }
}

// The sensor starts again in the second half of the recording, or its clock is set.
std::size_t points_with_second_start(const SensorCase& first, const SensorCase& second) {
  std::vector<std::string> packets = first.packets;
  packets.insert(packets.end(), second.packets.begin(), second.packets.end());
  return points_in(read_packets(first, packets).sweeps);
}

TEST(PacketOrderTest, ASecondStartIsNotTooLate) {
  const std::vector<SensorCase> first = sensor_cases();
  for (const double begin_s : {0.0, 9.0, 300.0}) {
    SCOPED_TRACE(begin_s);
    const std::vector<SensorCase> second = sensor_cases(begin_s);
    for (std::size_t i = 0; i < first.size(); ++i) {
      SCOPED_TRACE(first[i].name);
      const std::size_t once = points_in(read_packets(first[i], first[i].packets).sweeps);
      EXPECT_GE(points_with_second_start(first[i], second[i]), 2 * once);
    }
  }
}

}  // namespace
}  // namespace rilo::test
