// Packets of Velodyne and Ouster sensors in recordings.
#include <random>

#include "io/packets/packet_bytes.hpp"
#include "io/ros/driver_messages.hpp"
#include "io/ros/scan_containers.hpp"

namespace rilo::test {
namespace {

constexpr std::int64_t kFirstPacketStamp = 1'700'000'123'000'000'000;
constexpr int kPackets = 130;  // 30 a revolution

std::int64_t received_ns(int packet) { return kFirstPacketStamp + packet * 3'333'000LL; }
std::string vlp16(int packet) {
  return velodyne_packet((9000 + packet * 1200) % 36000, 100, 100 + static_cast<std::uint32_t>(packet) * 3333, 0x22);
}

// Scans of 31 packets: their borders lie anywhere in the revolutions.
std::vector<Recorded> velodyne_scans(bool ros1) {
  constexpr int kAScan = 31;
  std::vector<Recorded> messages;
  for (int first = 0; first < kPackets; first += kAScan) {
    const int count = std::min(kAScan, kPackets - first);
    Bytes bytes(!ros1);
    put_header(bytes, ros1, received_ns(first), "velodyne");
    bytes.put(static_cast<std::uint32_t>(count));
    for (int i = first; i < first + count; ++i) {
      bytes.put(static_cast<std::uint32_t>(received_ns(i) / 1'000'000'000));
      bytes.put(static_cast<std::uint32_t>(received_ns(i) % 1'000'000'000)).raw(vlp16(i));
    }
    messages.push_back({"/velodyne_packets", received_ns(first + count), finished(bytes, ros1)});
  }
  return messages;
}

void expect_same_sweeps(const std::vector<Sweep>& sweeps, const std::vector<Sweep>& expected) {
  ASSERT_EQ(sweeps.size(), expected.size());
  for (std::size_t i = 0; i < sweeps.size(); ++i) expect_same_sweep(sweeps[i], expected[i]);
}

TEST(VelodyneScanTest, TheSweepsOfACaptureInEveryContainer) {
  const TempDir folder;
  Capture capture;
  for (int i = 0; i < kPackets; ++i) capture.udp(received_ns(i), 2368, vlp16(i));
  const auto expected = sweeps_of(*open_scan_source(folder.write("v.pcap", capture.text())));
  ASSERT_EQ(expected.size(), 4U);
  for (const auto& path :
       in_every_container(folder, {{"/velodyne_packets", "velodyne_msgs", "VelodyneScan"}}, velodyne_scans)) {
    SCOPED_TRACE(path.filename());
    const auto source = open_scan_source(path);
    expect_same_sweeps(sweeps_of(*source), expected);
    const SourceInfo info = source->info();
    EXPECT_EQ(info.kind, "packets");
    EXPECT_EQ(info.topic, "/velodyne_packets");
    EXPECT_EQ(info.frame_id, "velodyne");
    EXPECT_NE(info.format.find(", Velodyne VLP-16"), std::string::npos);
    EXPECT_TRUE(has_warning(info, "dropped 2 incomplete revolutions"));
  }
}

TEST(VelodyneScanTest, AMessageOfAnotherFrameIsAnError) {
  const TempDir folder;
  const std::string usual = "velodyne";
  std::vector<Recorded> messages = velodyne_scans(false);
  std::string& last = messages.back().bytes;
  last.replace(last.find(usual), usual.size(), "velodyn2");
  const auto file = folder.write(
      "two.mcap", mcap_bytes({{"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan"}}, messages, {"zstd", 2, true}));
  expect_io_error([&] { sweeps_of(*open_scan_source(file)); },
                  {"message 5 of /velodyne_packets", "'velodyn2'", "'velodyne'", "one sensor in a topic"});
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto source = open_scan_source(file, options);
  EXPECT_GE(sweeps_of(*source).size(), 3U);
  EXPECT_EQ(source->info().frame_id, usual);
  EXPECT_EQ(source->info().bad_sweeps, 1U);
}

// --- Ouster -------------------------------------------------------------------------------------------------------

std::string text_message(bool ros1, const std::string& text) { return finished(Bytes(!ros1).string(text), ros1); }
std::string packet_message(bool ros1, const std::string& packet) {
  return finished(Bytes(!ros1).sequence(packet), ros1);
}

// 70 packets: a frame of 64 and the beginning of the next. `more`: bytes that the buffer has behind the packet.
std::vector<Recorded> ouster_messages(bool ros1, const OusterShape& shape, bool with_metadata, std::size_t more = 0) {
  std::vector<Recorded> messages;
  if (with_metadata)
    messages.push_back({"/os_node/metadata", kFirstPacketStamp, text_message(ros1, ouster_metadata(shape))});
  for (std::size_t i = 0; i < 70; ++i) {
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    const std::int64_t at = kFirstPacketStamp + static_cast<std::int64_t>(ns);
    const std::string packet = ouster_packet(shape, static_cast<std::uint16_t>(7 + i / 64), i % 64 * 16, ns);
    messages.push_back({"/os_node/lidar_packets", at, packet_message(ros1, packet + std::string(more, '\0'))});
    messages.push_back({"/os_node/imu_packets", at, packet_message(ros1, std::string(48 + more, 'i'))});
  }
  return messages;
}

std::vector<TopicInBoth> ouster_topics(const std::string& package, bool with_metadata) {
  std::vector<TopicInBoth> topics{{"/os_node/lidar_packets", package, "PacketMsg"},
                                  {"/os_node/imu_packets", package, "PacketMsg"}};
  if (with_metadata) topics.push_back({"/os_node/metadata", "std_msgs", "String"});
  return topics;
}

void expect_frame(ScanSource& source, const OusterShape& shape) {
  const auto sweeps = sweeps_of(source);
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].points.size(), 1024U * 3);  // the lowest beam has no return
  EXPECT_EQ(sweeps[0].stamp_ns, kFirstPacketStamp + 5'000'000);
  EXPECT_EQ(source.info().topic, "/os_node/lidar_packets");
  EXPECT_NE(source.info().format.find("Ouster OS-1-4, " + shape.profile), std::string::npos);
}

void expect_frame_in_every_container(const std::string& package, const OusterShape& shape) {
  const TempDir folder;
  const auto messages = [&](bool ros1) { return ouster_messages(ros1, shape, true); };
  for (const auto& path : in_every_container(folder, ouster_topics(package, true), messages)) {
    SCOPED_TRACE(package + ", " + shape.profile + ", " + path.filename().string());
    expect_frame(*open_scan_source(path), shape);
  }
}

TEST(OusterPacketsTest, EveryPackageProfileAndContainer) {
  for (const OusterShape& shape : kOusterShapes) expect_frame_in_every_container("ouster_ros", shape);
  for (const char* package : {"ouster_msgs", "ouster_sensor_msgs"}) {
    expect_frame_in_every_container(package, kOusterShapes[2]);
  }
}

// Ouster's first drivers: no topic of metadata, and a byte more than the packet.
TEST(OusterPacketsTest, FirstDriversWithMetadataBeside) {
  const OusterShape& shape = kOusterShapes[0];
  const TempDir folder;
  const auto messages = [&](bool ros1) { return ouster_messages(ros1, shape, false, 1); };
  const auto paths = in_every_container(folder, ouster_topics("ouster_ros", false), messages);
  for (const auto& path : paths) {
    SCOPED_TRACE(path.filename());
    expect_io_error([&] { open_scan_source(path); },
                    {path.string(), "packets: 70 of 1088 bytes", "no metadata of an Ouster", "--sensor-file"});
  }
  SourceOptions options;
  options.sensor_file = folder.write("sensor/m.json", ouster_metadata(shape)).string();
  for (const auto& path : paths) expect_frame(*open_scan_source(path, options), shape);
  folder.write("db3.json", ouster_metadata(shape));  // of the rosbag2 folder's name
  expect_frame(*open_scan_source(folder / "db3"), shape);
}

TEST(OusterPacketsTest, MetadataOfTheOtherSensorIsNotTaken) {
  const TempDir folder;
  auto messages = ouster_messages(false, kOusterShapes[2], true);
  messages.push_back({"/rear/metadata", kFirstPacketStamp, text_message(false, ouster_metadata(kOusterShapes[0]))});
  Topics topics{{"/rear/metadata", "std_msgs/msg/String"}};
  for (const auto& topic : ouster_topics("ouster_ros", true)) topics.emplace_back(topic.name, topic.full_type(false));
  expect_frame(*open_scan_source(folder.write("o.mcap", mcap_bytes(topics, messages, {}))), kOusterShapes[2]);
}

TEST(OusterPacketsTest, MetadataThatDoNotFit) {
  const TempDir folder;
  const auto write = [&](const std::string& metadata) {
    auto messages = ouster_messages(false, kOusterShapes[2], true);
    messages[0].bytes = text_message(false, metadata);
    Topics topics;
    for (const auto& topic : ouster_topics("ouster_ros", true)) topics.emplace_back(topic.name, topic.full_type(false));
    return folder.write("o.mcap", mcap_bytes(topics, messages, {}));
  };
  const auto other = write(ouster_metadata(kOusterShapes[0]));
  expect_io_error([&] { open_scan_source(other); },
                  {"o.mcap", "70 of 1024 bytes", "1088 bytes, as in topic /os_node/metadata"});
  const auto broken = write(R"({"lidar_mode": "1024x0"})");
  expect_io_error([&] { open_scan_source(broken); }, {"o.mcap", "topic /os_node/metadata, lidar_mode", "'1024x0'"});
}

// --- which topic --------------------------------------------------------------------------------------------------

TEST(PacketTopicsTest, CloudsAreTakenBeforePackets) {
  const TempDir folder;
  auto messages = velodyne_scans(false);
  for (Recorded& cloud : recorded(numbered_sweeps(4), MessageEncoding::kCdr)) {
    messages.push_back(std::move(cloud));
  }
  const auto file = folder.write(
      "both.mcap",
      mcap_bytes({{"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan"}, {"/points", kRos2Type}}, messages, {}));
  EXPECT_EQ(open_scan_source(file)->info().topic, "/points");
  SourceOptions options;
  options.topic = "velodyne_packets";  // without the slash
  EXPECT_EQ(open_scan_source(file, options)->info().topic, "/velodyne_packets");
}

TEST(PacketTopicsTest, SeveralOrNoneAreListed) {
  const TempDir folder;
  auto messages = velodyne_scans(false);
  messages.push_back({"/rear/packets", kFirstPacketStamp, messages[0].bytes});
  const std::string type = "velodyne_msgs/msg/VelodyneScan";
  const auto two =
      folder.write("two.mcap", mcap_bytes({{"/velodyne_packets", type}, {"/rear/packets", type}}, messages, {}));
  expect_io_error(
      [&] { open_scan_source(two); },
      {"2 topics of LiDAR packets", "/rear/packets (velodyne_msgs/msg/VelodyneScan, 1 message)", "--topic"});
  const auto none = folder.write("none.mcap", mcap_bytes({{"/imu", "sensor_msgs/msg/Imu"}}, {{"/imu", 1, "x"}}, {}));
  expect_io_error([&] { open_scan_source(none); }, {"/imu (sensor_msgs/msg/Imu, 1 message)", "Livox CustomMsg"});
}

// --- hostile ------------------------------------------------------------------------------------------------------

TEST(PacketTopicsTest, CutOffAtEveryByte) {
  for (const bool ros1 : {true, false}) {
    const auto encoding = ros1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
    const std::string scan = velodyne_scans(ros1).back().bytes;  // of 6 packets
    EXPECT_EQ(detail::parse_velodyne_scan(scan, encoding, {"v"}).packets.size(), 6U);
    expect_refused_cuts(scan,
                        [&](const std::string& cut) {
                          detail::parse_velodyne_scan(cut, encoding, {"v.bag", "message 1"});
                        },
                        {"v.bag", "message 1", "byte"});
    const std::string packet = packet_message(ros1, "packet");
    EXPECT_EQ(detail::parse_ouster_packet(packet, encoding, {"o"}), "packet");
    expect_refused_cuts(packet,
                        [&](const std::string& cut) {
                          detail::parse_ouster_packet(cut, encoding, {"o.bag", "message 1"});
                        },
                        {"o.bag", "message 1", "byte"});
  }
}

TEST(PacketTopicsTest, ATruncatedMessageIsAnErrorOrCounted) {
  const TempDir folder;
  auto messages = velodyne_scans(false);
  messages[2].bytes.resize(5000);
  const auto file =
      folder.write("v.mcap", mcap_bytes({{"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan"}}, messages, {}));
  const auto failing = open_scan_source(file);
  std::size_t before = 0;
  expect_io_error(
      [&] {
        while (failing->next()) ++before;
      },
      {"v.mcap", "message 3 of /velodyne_packets", "byte"});
  EXPECT_EQ(before, 1U);  // the revolution that the message cuts in two comes after it
  std::size_t after = 0;
  while (failing->next()) ++after;
  EXPECT_GE(after, 1U);
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto skipping = open_scan_source(file, options);
  EXPECT_EQ(sweeps_of(*skipping).size(), before + after);
  EXPECT_EQ(skipping->info().bad_sweeps, 1U);
  EXPECT_TRUE(has_warning(skipping->info(), "dropped 1 message that could not be read"));
  EXPECT_EQ(open_scan_source(file)->skip(100), before + after);
}

TEST(PacketTopicsTest, PacketsOfAnotherSizeAreCounted) {
  const TempDir folder;
  auto messages = ouster_messages(false, kOusterShapes[2], true);
  for (const std::size_t i : {21U, 41U}) messages[i].bytes = packet_message(false, "short");
  Topics topics;
  for (const auto& topic : ouster_topics("ouster_ros", true)) topics.emplace_back(topic.name, topic.full_type(false));
  const auto source = open_scan_source(folder.write("o.mcap", mcap_bytes(topics, messages, {})));
  const auto sweeps = sweeps_of(*source);
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].points.size(), 62U * 16 * 3);
  EXPECT_TRUE(has_warning(source->info(), "dropped 2 packets of another size"));
}

TEST(PacketTopicsTest, HostileBytes) {
  const TempDir folder;
  std::mt19937 random(5);
  for (int round = 0; round < 60; ++round) {
    auto messages = velodyne_scans(false);
    for (int k = 0; k < 20; ++k) {
      std::string& bytes = messages[random() % messages.size()].bytes;
      bytes[random() % bytes.size()] = static_cast<char>(random());
      if (k < 3) bytes[random() % 60] = static_cast<char>(random());
    }
    const auto file =
        folder.write("h.mcap", mcap_bytes({{"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan"}}, messages, {}));
    SourceOptions options;
    options.on_bad_sweep = round % 2 == 0 ? OnBadSweep::kSkip : OnBadSweep::kFail;
    reads_or_refuses([&] { EXPECT_LE(sweeps_of(*open_scan_source(file, options)).size(), 60U); });
  }
}

}  // namespace
}  // namespace rilo::test
