// MCAP, rosbag2 and ROS 1 bags: the same sweeps out of every container.
#include <functional>
#include <random>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

const Topics kRos1Topics{{"/imu", "sensor_msgs/Imu"}, {"/points", kRos1Type}};
const Topics kRos2Topics{{"/imu", "sensor_msgs/msg/Imu"}, {"/points", kRos2Type}};

// With messages of another topic in between.
std::vector<Recorded> with_imu(const std::vector<Sweep>& sweeps, MessageEncoding encoding) {
  std::vector<Recorded> all;
  for (Recorded& message : recorded(sweeps, encoding)) {
    all.push_back({"/imu", message.received_ns - 1, "no cloud at all"});
    all.push_back(std::move(message));
    all.push_back({"/imu", all.back().received_ns + 1, std::string(3000, 'x')});
  }
  return all;
}

struct Container {
  std::string name;
  std::function<fs::path(const TempDir&, const std::vector<Sweep>&)> write;
  std::string format;  // as info() says after reading
};

Container mcap(const std::string& name, const McapShape& shape, const std::string& format) {
  const bool ros1 = shape.encoding == "ros1";
  return {name,
          [=](const TempDir& folder, const std::vector<Sweep>& sweeps) {
            const auto messages = with_imu(sweeps, ros1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr);
            return folder.write(name + ".mcap", mcap_bytes(ros1 ? kRos1Topics : kRos2Topics, messages, shape));
          },
          format};
}

fs::path write_rosbag2(const TempDir& folder, const std::vector<Sweep>& sweeps, const std::string& storage,
                       const std::string& mode) {
  const std::string name = "b_" + storage + mode;
  const fs::path file = folder.write(name + "/b_0." + (storage == "mcap" ? "mcap" : "db3"), "");
  auto messages = with_imu(sweeps, MessageEncoding::kCdr);
  if (mode == "MESSAGE") {
    for (Recorded& message : messages) message.bytes = zstd_of(message.bytes);
  }
  fs::remove(file);
  if (storage == "mcap") {
    folder.write(name + "/b_0.mcap", mcap_bytes(kRos2Topics, messages, {}));
  } else {
    write_db3(file, kRos2Topics, messages);
  }
  std::string stored = file.filename().string();
  if (mode == "FILE") {
    const std::string bytes = slurp(file);
    folder.write(name + "/" + stored + ".zstd", zstd_of(bytes));
    fs::remove(file);
    stored += ".zstd";
  }
  folder.write(name + "/metadata.yaml", metadata_yaml({stored}, storage, mode));
  return folder / name;
}

Container rosbag2(const std::string& storage, const std::string& mode, const std::string& format) {
  return {"rosbag2 " + storage + " " + mode,
          [=](const TempDir& folder, const std::vector<Sweep>& sweeps) {
            return write_rosbag2(folder, sweeps, storage, mode);
          },
          format};
}

std::vector<Container> containers() {
  std::vector<Container> all{
      mcap("plain", {}, "mcap"),
      mcap("zstd", {"zstd", 2, true, "cdr"}, "mcap (zstd)"),
      mcap("lz4", {"lz4", 3, true, "cdr"}, "mcap (lz4)"),
      mcap("unchunked", {"", 0, true, "cdr"}, "mcap"),
      mcap("unchunked_no_summary", {"", 0, false, "cdr"}, "mcap"),
      mcap("no_summary", {"zstd", 4, false, "cdr"}, "mcap (zstd)"),
      mcap("no_schemas", {"zstd", 2, true, "cdr", "schemas"}, "mcap (zstd)"),
      mcap("no_channels", {"", 2, true, "cdr", "channels"}, "mcap"),
      mcap("ros1", {"lz4", 1, true, "ros1"}, "mcap (lz4)"),
      rosbag2("sqlite3", "", "rosbag2 (sqlite3)"),
      rosbag2("sqlite3", "MESSAGE", "rosbag2 (sqlite3), messages in zstd"),
      rosbag2("sqlite3", "FILE", "rosbag2 (sqlite3), file in zstd"),
      rosbag2("mcap", "", "mcap"),
      rosbag2("mcap", "MESSAGE", "mcap, messages in zstd"),
      rosbag2("mcap", "FILE", "mcap, file in zstd"),
  };
#ifdef RILO_HAS_ROSBAG
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    all.push_back({"bag " + compression,
                   [=](const TempDir& folder, const std::vector<Sweep>& sweeps) {
                     const auto messages = with_imu(sweeps, MessageEncoding::kRos1);
                     write_bag(folder / (compression + ".bag"), kRos1Topics, messages, compression);
                     return folder / (compression + ".bag");
                   },
                   "ROS 1 bag"});
  }
#endif
  return all;
}

TEST(RecordingTest, EverySweepOutOfEveryContainer) {
  const auto sweeps = numbered_sweeps(5);
  for (const Container& container : containers()) {
    SCOPED_TRACE(container.name);
    const TempDir folder;
    const auto source = open_scan_source(container.write(folder, sweeps));
    EXPECT_EQ(source->size(), 5U);
    EXPECT_NEAR(source->info().period_s, 0.1, 1e-9);
    EXPECT_TRUE(source->info().has_point_times);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      const auto sweep = source->next();
      ASSERT_TRUE(sweep);
      expect_same_sweep(*sweep, sweeps[i]);
      EXPECT_EQ(source->current_index(), i);
    }
    EXPECT_FALSE(source->next());
    EXPECT_FALSE(source->next());
    const SourceInfo info = source->info();
    EXPECT_EQ(info.kind, "recording");
    EXPECT_EQ(info.format, container.format);
    EXPECT_EQ(info.topic, "/points");
    EXPECT_EQ(info.frame_id, "lidar");
    EXPECT_EQ(info.point_times, "field time (float32), s since the sweep's stamp");
    EXPECT_EQ(info.faults, StampFaults{});
    EXPECT_TRUE(info.warnings.empty()) << info.warnings[0];
  }
}

TEST(RecordingTest, SkippingIsAsReading) {
  const auto sweeps = numbered_sweeps(5);
  for (const Container& container : containers()) {
    SCOPED_TRACE(container.name);
    const TempDir folder;
    const auto source = open_scan_source(container.write(folder, sweeps));
    EXPECT_EQ(source->skip(2), 2U);
    expect_same_sweep(source->next().value(), sweeps[2]);
    EXPECT_EQ(source->skip(1), 1U);
    expect_same_sweep(source->next().value(), sweeps[4]);
    EXPECT_EQ(source->current_index(), 4U);
    EXPECT_EQ(source->skip(9), 0U);
    EXPECT_FALSE(source->next());
    EXPECT_EQ(source->info().faults.gaps, 0U);  // what is skipped is no gap
  }
}

TEST(RecordingTest, SeveralTopics) {
  const TempDir folder;
  const Topics topics{{"/front", kRos2Type}, {"/imu", "sensor_msgs/msg/Imu"}, {"/rear", kRos2Type}};
  auto messages = recorded(numbered_sweeps(3), MessageEncoding::kCdr);
  for (Recorded& message : messages) message.topic = "/rear";
  messages[1].topic = "/front";
  for (const std::size_t chunk : {std::size_t{0}, std::size_t{1}}) {
    const fs::path file = folder.write("two.mcap", mcap_bytes(topics, messages, {"zstd", chunk, true, "cdr"}));
    expect_io_error([&] { open_scan_source(file); },
                    {"two.mcap", "2 topics of point clouds", "/front (sensor_msgs/msg/PointCloud2, 1 message)",
                     "/rear (sensor_msgs/msg/PointCloud2, 2 messages)", "--topic"});
    SourceOptions options;
    options.topic = "/front";
    const auto source = open_scan_source(file, options);
    EXPECT_EQ(source->size(), 1U);
    expect_same_sweep(source->next().value(), numbered_sweeps(2)[1]);
    EXPECT_FALSE(source->next());
    options.topic = "/none";
    expect_io_error([&] { open_scan_source(file, options); }, {"'/none'", "/imu (sensor_msgs/msg/Imu, 0 messages)"});
    options.topic = "/imu";
    expect_io_error([&] { open_scan_source(file, options); },
                    {"the topic '/imu' with messages of type sensor_msgs/PointCloud2"});
  }
  const fs::path none = folder.write("none.mcap", mcap_bytes({{"/imu", "sensor_msgs/msg/Imu"}}, {}, {}));
  expect_io_error([&] { open_scan_source(none); }, {"/imu", "a topic of type sensor_msgs/PointCloud2"});
  const fs::path flat = folder.write("flat.mcap", mcap_bytes({{"/scan", "sensor_msgs/msg/LaserScan"}}, {}, {}));
  expect_io_error([&] { open_scan_source(flat); }, {"/scan", "scans of one plane (LaserScan)"});
}

TEST(RecordingTest, SplitRecordingsContinue) {
  const auto sweeps = numbered_sweeps(4);
  const TempDir folder;
  const auto messages = recorded(sweeps, MessageEncoding::kCdr);
  write_db3(folder.write("split/s_0.db3", ""), kRos2Topics, {messages[0], messages[1]});
  write_db3(folder.write("split/s_1.db3", ""), kRos2Topics, {{"/imu", 1, "x"}});
  write_db3(folder.write("split/s_10.db3", ""), kRos2Topics, {messages[2], messages[3]});
  const auto expect_all = [&](const fs::path& path) {
    const auto source = open_scan_source(path);
    EXPECT_EQ(source->size(), 4U);
    for (const Sweep& sweep : sweeps) expect_same_sweep(source->next().value(), sweep);
    EXPECT_FALSE(source->next());
    const auto again = open_scan_source(path);
    EXPECT_EQ(again->skip(3), 3U);
    expect_same_sweep(again->next().value(), sweeps[3]);
  };
  expect_all(folder / "split");  // the recorder was killed: no metadata.yaml
  folder.write("split/metadata.yaml", metadata_yaml({"old/s_0.db3", "s_1.db3", "s_10.db3"}, "sqlite3"));
  expect_all(folder / "split");
#ifdef RILO_HAS_ROSBAG
  const auto ros1 = recorded(sweeps, MessageEncoding::kRos1);
  fs::create_directory(folder / "bags");
  write_bag(folder / "bags/d_2.bag", kRos1Topics, {ros1[0]});
  write_bag(folder / "bags/d_10.bag", kRos1Topics, {ros1[1], ros1[2], ros1[3]}, "bz2");
  expect_all(folder / "bags");
#endif
}

// A recorder that was killed, or a file on its own.
TEST(RecordingTest, PackedFilesWithoutMetadata) {
  const auto sweeps = numbered_sweeps(3);
  const TempDir folder;
  for (const std::string storage : {"sqlite3", "mcap"}) {
    const fs::path path = write_rosbag2(folder, sweeps, storage, "FILE");
    fs::remove(path / "metadata.yaml");
    for (const fs::path& data : {path, path / (storage == "mcap" ? "b_0.mcap.zstd" : "b_0.db3.zstd")}) {
      SCOPED_TRACE(data.string());
      const auto source = open_scan_source(data);
      for (const Sweep& sweep : sweeps) expect_same_sweep(source->next().value(), sweep);
      EXPECT_FALSE(source->next());
    }
  }
}

// Drivers of several sensors may publish them all under one name.
TEST(RecordingTest, ASecondSensorInTheTopicIsNamed) {
  const auto sweeps = numbered_sweeps(4);
  auto messages = recorded(sweeps, MessageEncoding::kCdr);
  const TempDir folder;
  const fs::path one = folder.write("one.mcap", mcap_bytes(kRos2Topics, messages, {}));
  for (const std::size_t i : {1U, 3U}) {
    CloudMessage other = message_of(sweeps[i]);
    other.frame_id = "lidar_rear";
    messages[i].bytes = message_bytes(other, MessageEncoding::kCdr);
  }
  const fs::path file = folder.write("two.mcap", mcap_bytes(kRos2Topics, messages, {}));
  const auto source = open_scan_source(file);
  EXPECT_DOUBLE_EQ(source->info().period_s, 2 * open_scan_source(one)->info().period_s);  // of the first sensor
  expect_same_sweep(source->next().value(), sweeps[0]);
  expect_io_error([&] { source->next(); }, {"message 2 of /points", "lidar_rear", "one sensor in a topic"});
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto first = open_scan_source(file, options);
  expect_same_sweep(first->next().value(), sweeps[0]);
  expect_same_sweep(first->next().value(), sweeps[2]);
  EXPECT_FALSE(first->next());
}

TEST(RecordingTest, AnEmptySerializationFormatIsCdr) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(2);
  const auto messages = recorded(sweeps, MessageEncoding::kCdr);
  write_db3(folder / "e.db3", kRos2Topics, messages, "");
  expect_same_sweep(open_scan_source(folder / "e.db3")->next().value(), sweeps[0]);
  write_db3(folder / "f.db3", kRos2Topics, messages, "flat");
  expect_io_error([&] { open_scan_source(folder / "f.db3"); }, {"f.db3", "encoding 'flat'"});
}

std::size_t read_all(const fs::path& file) {
  SourceOptions options;
  options.read_ahead = 0;
  const auto source = open_scan_source(file, options);
  std::size_t sweeps = 0;
  for (std::size_t errors = 0; errors < 100;) {
    bool more = true;
    if (!reads_or_refuses([&] { more = source->next().has_value(); })) {
      ++errors;
      continue;
    }
    if (!more) return sweeps;
    ++sweeps;
  }
  ADD_FAILURE() << "errors without end";
  return sweeps;
}

// Cut off and turned over: sweeps or an IoError, nothing else, and an end.
TEST(RecordingTest, HostileBytes) {
  std::mt19937 random(11);
  for (const Container& container : containers()) {
    if (container.format.starts_with("ROS 1")) continue;  // ROS' library reads past the end of damaged headers
    SCOPED_TRACE(container.name);
    const TempDir folder;
    const fs::path path = container.write(folder, numbered_sweeps(3, 8));
    fs::path file = path;
    if (fs::is_directory(path)) {
      for (const auto& entry : fs::directory_iterator(path)) {
        if (entry.path().filename() != "metadata.yaml") file = entry.path();
      }
    }
    const std::string whole = slurp(file);
    for (int round = 0; round < 150; ++round) {
      std::ofstream(file, std::ios::binary) << damaged(whole, round, round % 5, random);
      reads_or_refuses([&] { EXPECT_LE(read_all(path), 100U); });
    }
  }
}

}  // namespace
}  // namespace rilo::test
