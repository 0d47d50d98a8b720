// Recordings that are cut off, damaged, or made to harm.
#include <random>
#include <sqlite3.h>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/ros/unpack.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

const Topics kTopics{{"/imu", "sensor_msgs/msg/Imu"}, {"/points", kRos2Type}};

TEST(DamagedRecordingTest, CutOffMcapIsReadAsFarAsItGoes) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(5);
  const std::string whole = mcap_bytes(kTopics, recorded(sweeps, MessageEncoding::kCdr), {"zstd", 2, true});
  const auto whole_chunks =
      mcap_bytes(kTopics, recorded(numbered_sweeps(4), MessageEncoding::kCdr), {"zstd", 2, false});
  // Inside the last chunk: the first two, four sweeps, are whole.
  const std::size_t cut = whole_chunks.size() - 30;  // behind them: 50 bytes of end of data, footer and magic
  const auto source = open_scan_source(folder.write("cut.mcap", whole.substr(0, cut)));
  for (std::size_t i = 0; i < 4; ++i) expect_same_sweep(source->next().value(), sweeps[i]);
  EXPECT_FALSE(source->next());
  EXPECT_TRUE(has_warning(source->info(), "cut off in the record at byte"));
}

TEST(DamagedRecordingTest, ADamagedChunkIsLeftOut) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(3);
  std::string bytes = mcap_bytes(kTopics, recorded(sweeps, MessageEncoding::kCdr), {"", 1, true});
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

TEST(DamagedRecordingTest, FilesThatAreNone) {
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
  folder.write("m/metadata.yaml", metadata_yaml({"gone.db3"}, "sqlite3"));
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"'gone.db3'", "not in the folder"});
  folder.write("m/gone.db3.zstd", "no zstd");
  folder.write("m/metadata.yaml", metadata_yaml({"gone.db3.zstd"}, "sqlite3", "FILE"));
  expect_io_error([&] { open_scan_source(folder / "m"); }, {"gone.db3.zstd", "zstd data"});
}

// A recorder that was killed leaves an empty last file; the others are whole.
TEST(DamagedRecordingTest, AFileOfASplitRecordingIsLeftOut) {
  const TempDir folder;
  const auto sweeps = numbered_sweeps(4);
  const auto messages = recorded(sweeps, MessageEncoding::kCdr);
  folder.write("m/m_0.mcap", mcap_bytes(kTopics, {messages[0], messages[1]}, {"zstd", 2, true}));
  folder.write("m/m_1.mcap", "");
  folder.write("m/m_2.mcap", mcap_bytes(kTopics, {messages[2], messages[3]}, {"zstd", 2, true}));
  const auto source = open_scan_source(folder / "m");
  EXPECT_EQ(source->size(), 4U);
  for (const Sweep& sweep : sweeps) expect_same_sweep(source->next().value(), sweep);
  EXPECT_FALSE(source->next());
  EXPECT_TRUE(has_warning(source->info(), "left out: " + (folder / "m/m_1.mcap").string()));
  folder.write("none/m_0.mcap", "");
  folder.write("none/m_1.mcap", "");
  expect_io_error([&] { open_scan_source(folder / "none"); }, {"m_1.mcap", "0 bytes"});
}

TEST(DamagedRecordingTest, AnMcapCutOffBeforeItsFirstChunkSaysSo) {
  const TempDir folder;
  const std::string whole = mcap_bytes(kTopics, recorded(numbered_sweeps(2), MessageEncoding::kCdr), {});
  expect_io_error([&] { open_scan_source(folder.write("cut.mcap", whole.substr(0, 40))); }, {"no topics", "cut off"});
}

// Without metadata.yaml nothing says that the messages are packed.
TEST(DamagedRecordingTest, PackedMessagesWithoutMetadataAreNamed) {
  const TempDir folder;
  auto messages = recorded(numbered_sweeps(2), MessageEncoding::kCdr);
  for (auto& message : messages) message.bytes = zstd_of(message.bytes);
  write_db3(folder.write("d/d_0.db3", ""), kTopics, messages);
  const auto source = open_scan_source(folder / "d");
  expect_io_error([&] { source->next(); }, {"message 1 of /points", "zstd", "metadata.yaml"});
}

// A view could compute for ever.
TEST(DamagedRecordingTest, ADatabaseWithViewsIsRefused) {
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
TEST(DamagedRecordingTest, ADatabaseOfRowsWithoutEnd) {
  const TempDir folder;
  const fs::path file = folder / "e.db3";
  write_db3(file, kTopics, recorded(numbered_sweeps(1, 4), MessageEncoding::kCdr));
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(database, "SELECT rootpage FROM sqlite_master WHERE name = 'messages'", -1, &row, nullptr);
  ASSERT_EQ(sqlite3_step(row), SQLITE_ROW);
  const auto root = static_cast<std::size_t>(sqlite3_column_int(row, 0));
  sqlite3_finalize(row);
  sqlite3_close(database);
  std::string bytes = slurp(file);
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
TEST(DamagedRecordingTest, AnnouncedSizesAreNotBelieved) {
  const TempDir folder;
  const auto messages = recorded(numbered_sweeps(1), MessageEncoding::kCdr);
  std::string bytes = mcap_bytes(kTopics, messages, {"zstd", 1, true});
  const std::size_t chunk = bytes.find('\x06', 30);
  for (std::size_t i = 0; i < 7; ++i) bytes[chunk + 9 + 16 + i] = '\x7F';
  const auto source = open_scan_source(folder.write("big.mcap", bytes));
  expect_io_error([&] { source->next(); }, {"big.mcap", "bytes unpacked"});
}

// Before the whole file was unpacked: the lack of room is found, and not the end that is missing.
TEST(UnpackTest, AFullDiskEndsItAtOnce) {
  const TempDir folder;
  std::mt19937 random(5);
  std::string bytes(1'000'000, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  const std::string packed = zstd_of(bytes);
  const auto file = folder.write("big.db3.zstd", packed.substr(0, packed.size() - 9));
  expect_io_error([&] { detail::unpack_zstd_file(file, "/dev/full"); }, {"/dev/full", "big.db3.zstd", "TMPDIR"});
}

}  // namespace
}  // namespace rilo::test
