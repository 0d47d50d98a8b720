// MCAP, rosbag2 and ROS 1 bags: the same sweeps out of every container.
#include <functional>
#include <random>
#include <sqlite3.h>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"

namespace rilo {
namespace {

using test::expect_io_error;
using test::expect_same_sweep;
using test::has_warning;
using test::kRos1Type;
using test::kRos2Type;
using test::McapShape;
using test::numbered_sweeps;
using test::Recorded;
using test::recorded;
using test::TempDir;
using test::Topics;
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
            return folder.write(name + ".mcap", test::mcap_bytes(ros1 ? kRos1Topics : kRos2Topics, messages, shape));
          },
          format};
}

fs::path write_rosbag2(const TempDir& folder, const std::vector<Sweep>& sweeps, const std::string& storage,
                       const std::string& mode) {
  const std::string name = "b_" + storage + mode;
  const fs::path file = folder.write(name + "/b_0." + (storage == "mcap" ? "mcap" : "db3"), "");
  auto messages = with_imu(sweeps, MessageEncoding::kCdr);
  if (mode == "MESSAGE") {
    for (Recorded& message : messages) message.bytes = test::zstd_of(message.bytes);
  }
  fs::remove(file);
  if (storage == "mcap") {
    folder.write(name + "/b_0.mcap", test::mcap_bytes(kRos2Topics, messages, {}));
  } else {
    test::write_db3(file, kRos2Topics, messages);
  }
  std::string stored = file.filename().string();
  if (mode == "FILE") {
    const std::string bytes = test::slurp(file);
    folder.write(name + "/" + stored + ".zstd", test::zstd_of(bytes));
    fs::remove(file);
    stored += ".zstd";
  }
  folder.write(name + "/metadata.yaml", test::metadata_yaml({stored}, storage, mode));
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
                     test::write_bag(folder / (compression + ".bag"), kRos1Topics, messages, compression);
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
    const fs::path file = folder.write("two.mcap", test::mcap_bytes(topics, messages, {"zstd", chunk, true, "cdr"}));
    expect_io_error([&] { open_scan_source(file); },
                    {"two.mcap", "2 topics of point clouds", "/front (sensor_msgs/msg/PointCloud2, 1 messages)",
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
  const fs::path none = folder.write("none.mcap", test::mcap_bytes({{"/imu", "sensor_msgs/msg/Imu"}}, {}, {}));
  expect_io_error([&] { open_scan_source(none); }, {"/imu", "a topic of type sensor_msgs/PointCloud2"});
}

TEST(RecordingTest, SplitRecordingsContinue) {
  const auto sweeps = numbered_sweeps(4);
  const TempDir folder;
  const auto messages = recorded(sweeps, MessageEncoding::kCdr);
  test::write_db3(folder.write("split/s_0.db3", ""), kRos2Topics, {messages[0], messages[1]});
  test::write_db3(folder.write("split/s_1.db3", ""), kRos2Topics, {{"/imu", 1, "x"}});
  test::write_db3(folder.write("split/s_10.db3", ""), kRos2Topics, {messages[2], messages[3]});
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
  folder.write("split/metadata.yaml", test::metadata_yaml({"old/s_0.db3", "s_1.db3", "s_10.db3"}, "sqlite3"));
  expect_all(folder / "split");
#ifdef RILO_HAS_ROSBAG
  const auto ros1 = recorded(sweeps, MessageEncoding::kRos1);
  fs::create_directory(folder / "bags");
  test::write_bag(folder / "bags/d_2.bag", kRos1Topics, {ros1[0]});
  test::write_bag(folder / "bags/d_10.bag", kRos1Topics, {ros1[1], ros1[2], ros1[3]}, "bz2");
  expect_all(folder / "bags");
#endif
}

TEST(RecordingTest, CutOffMcapIsReadAsFarAsItGoes) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(5);
  const std::string whole = test::mcap_bytes(kRos2Topics, recorded(sweeps, MessageEncoding::kCdr), {"zstd", 2, true});
  const auto whole_chunks =
      test::mcap_bytes(kRos2Topics, recorded(numbered_sweeps(4), MessageEncoding::kCdr), {"zstd", 2, false});
  // Inside the last chunk: the first two, four sweeps, are whole.
  const std::size_t cut = whole_chunks.size() - 30;  // behind them: 50 bytes of end of data, footer and magic
  const auto source = open_scan_source(folder.write("cut.mcap", whole.substr(0, cut)));
  for (std::size_t i = 0; i < 4; ++i) expect_same_sweep(source->next().value(), sweeps[i]);
  EXPECT_FALSE(source->next());
  EXPECT_TRUE(has_warning(source->info(), "cut off in the record at byte"));
}

TEST(RecordingTest, ADamagedChunkIsLeftOut) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(3);
  std::string bytes = test::mcap_bytes(kRos2Topics, recorded(sweeps, MessageEncoding::kCdr), {"", 1, true});
  const std::size_t second = bytes.find("lidar", bytes.find("lidar") + 1);
  bytes[second + 200] = static_cast<char>(~bytes[second + 200]);
  const fs::path file = folder.write("bad.mcap", bytes);
  {
    const auto source = open_scan_source(file);
    expect_same_sweep(source->next().value(), sweeps[0]);
    expect_io_error([&] { source->next(); }, {"bad.mcap", "chunk at byte", "CRC"});
    expect_same_sweep(source->next().value(), sweeps[2]);
  }
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto source = open_scan_source(file, options);
  expect_same_sweep(source->next().value(), sweeps[0]);
  expect_same_sweep(source->next().value(), sweeps[2]);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->info().bad_sweeps, 1U);
}

TEST(RecordingTest, FilesThatAreNone) {
  const TempDir folder;
  expect_io_error([&] { open_scan_source(folder.write("a.mcap", "")); }, {"a.mcap, byte 0", "0 bytes"});
  expect_io_error([&] { open_scan_source(folder.write("b.mcap", "12345678901234")); }, {"byte 0", "start of an MCAP"});
  expect_io_error([&] { open_scan_source(folder.write("a.db3", "not SQLite, but long enough to be looked into")); },
                  {"a.db3", "SQLite3: "});
  expect_io_error([&] { open_scan_source(folder.write("b.db3", "")); }, {"b.db3", "no table topics"});
  expect_io_error([&] { open_scan_source(folder.write("a.bag", "#ROSBAG V1.2\n")); }, {"a.bag"});
  expect_io_error([&] { open_scan_source(folder.write("b.bag", "")); }, {"b.bag"});
  folder.write("m/metadata.yaml", "rosbag2_bagfile_information: [");
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"metadata.yaml", "not valid YAML"});
  folder.write("m/metadata.yaml", "x: 1\n");
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"metadata.yaml", "no rosbag2_bagfile_information"});
  folder.write("m/metadata.yaml", test::metadata_yaml({"gone.db3"}, "sqlite3"));
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"'gone.db3'", "not in the folder"});
  folder.write("m/gone.db3.zstd", "no zstd");
  folder.write("m/metadata.yaml", test::metadata_yaml({"gone.db3.zstd"}, "sqlite3", "FILE"));
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"gone.db3.zstd", "zstd data"});
}

// A view could compute for ever.
TEST(RecordingTest, ADatabaseWithViewsIsRefused) {
  const TempDir folder;
  const fs::path file = folder / "v.db3";
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
               "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id FROM n) SELECT id, 1 AS "
               "topic_id, 0 AS timestamp, '' AS data FROM n",
               nullptr, nullptr, nullptr);
  sqlite3_close(database);
  expect_io_error([&] { open_scan_source(file); }, {"v.db3", "no table messages"});
}

// An interior page of a B-tree of SQLite3: its 400 children are all the same.
std::string page_of_one_child(std::size_t bytes, std::uint32_t child) {
  constexpr std::size_t kChildren = 400;
  const auto big = [](std::size_t value, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(value >> 8 * (size - 1 - i) & 255);
    return text;
  };
  const std::size_t cell = bytes - 5;
  std::string page = '\x05' + big(0, 2) + big(kChildren, 2) + big(cell, 2) + '\0' + big(child, 4);
  for (std::size_t i = 0; i < kChildren; ++i) page += big(cell, 2);
  page.resize(cell);
  return page + big(child, 4) + '\1';
}

// 400^10 rows in a few pages.
TEST(RecordingTest, ADatabaseOfRowsWithoutEnd) {
  const TempDir folder;
  const fs::path file = folder / "e.db3";
  test::write_db3(file, kRos2Topics, recorded(numbered_sweeps(1, 4), MessageEncoding::kCdr));
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(database, "SELECT rootpage FROM sqlite_master WHERE name = 'messages'", -1, &row, nullptr);
  ASSERT_EQ(sqlite3_step(row), SQLITE_ROW);
  const auto root = static_cast<std::size_t>(sqlite3_column_int(row, 0));
  sqlite3_finalize(row);
  sqlite3_close(database);
  std::string bytes = test::slurp(file);
  const std::size_t page = static_cast<unsigned char>(bytes[16]) * 256U;
  ASSERT_EQ(page, 4096U);
  bytes += bytes.substr((root - 1) * page, page);  // the only leaf
  for (int level = 0; level < 9; ++level) {
    bytes += page_of_one_child(page, static_cast<std::uint32_t>(bytes.size() / page));
  }
  bytes.replace((root - 1) * page, page, page_of_one_child(page, static_cast<std::uint32_t>(bytes.size() / page)));
  bytes[31] = static_cast<char>(bytes.size() / page);
  expect_io_error([&] { open_scan_source(folder.write("e.db3", bytes)); }, {"e.db3", "more rows than"});
}

// Announced sizes are not believed: memory is what the data give.
TEST(RecordingTest, AnnouncedSizesAreNotBelieved) {
  const TempDir folder;
  const auto messages = recorded(numbered_sweeps(1), MessageEncoding::kCdr);
  std::string bytes = test::mcap_bytes(kRos2Topics, messages, {"zstd", 1, true});
  const std::size_t chunk = bytes.find('\x06', 30);
  for (std::size_t i = 0; i < 7; ++i) bytes[chunk + 9 + 16 + i] = '\x7F';
  const auto source = open_scan_source(folder.write("big.mcap", bytes));
  expect_io_error([&] { source->next(); }, {"big.mcap", "bytes unpacked"});
}

std::size_t read_all(const fs::path& file) {
  SourceOptions options;
  options.read_ahead = 0;
  const auto source = open_scan_source(file, options);
  std::size_t sweeps = 0;
  for (std::size_t errors = 0; errors < 100;) {
    bool more = true;
    if (!test::reads_or_refuses([&] { more = source->next().has_value(); })) {
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
    const std::string whole = test::slurp(file);
    for (int round = 0; round < 150; ++round) {
      std::ofstream(file, std::ios::binary) << test::damaged(whole, round, round % 5, random);
      test::reads_or_refuses([&] { EXPECT_LE(read_all(path), 100U); });
    }
  }
}

}  // namespace
}  // namespace rilo
