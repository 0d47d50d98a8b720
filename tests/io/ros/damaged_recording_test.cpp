// Recordings that are cut off, damaged, or made to harm.
#include <algorithm>
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

// Ten sweeps from `first` on, in chunks of three, and packets of another topic. The chunks with the damaged sweeps,
// counted in the file, are damaged.
std::string broken_mcap(std::initializer_list<int> damaged_sweeps, bool index, bool summary, std::size_t first = 0) {
  auto messages = recorded(numbered_sweeps(first + 10), MessageEncoding::kCdr);
  messages.erase(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(first));
  for (int k = 0; k < 2; ++k) messages.insert(messages.begin() + 3, {"/imu", 0, std::string(100, 'i')});
  McapShape shape{"", 3, summary};
  shape.message_index = index;
  std::string bytes = mcap_bytes(kTopics, messages, shape);
  for (const int sweep : damaged_sweeps) {
    std::size_t place = 0;
    for (int k = 0; k <= sweep; ++k) place = bytes.find("lidar", place + 1);
    bytes[place + 200] = static_cast<char>(~bytes[place + 200]);
  }
  return bytes;
}

std::unique_ptr<ScanSource> open_skipping(const fs::path& file) {
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  options.read_ahead = 0;
  return open_scan_source(file, options);
}

// Where each sweep of the source lay among the numbered ones, and where the source says it did.
std::vector<std::pair<std::size_t, std::size_t>> places_in(ScanSource& source) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  while (const auto sweep = source.next()) {
    places.emplace_back(static_cast<std::size_t>(sweep->points[0].x()), source.current_index());
  }
  return places;
}
using Places = std::vector<std::pair<std::size_t, std::size_t>>;

// Chunks: sweeps 0 to 2; the packets and 3; 4 to 6; 7 to 9.
TEST(DamagedRecordingTest, PlacesBehindADamagedChunkAreThose) {
  for (const auto& [index, summary] : {std::pair(true, true), {true, false}, {false, true}}) {
    SCOPED_TRACE(std::string(index ? "index " : "") + (summary ? "summary" : ""));
    const TempDir folder;
    const fs::path file = folder.write("b.mcap", broken_mcap({4}, index, summary));
    auto source = open_skipping(file);
    EXPECT_EQ(source->size(), 10U);
    EXPECT_EQ(places_in(*source), (Places{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {7, 7}, {8, 8}, {9, 9}}));
    EXPECT_EQ(source->info().bad_sweeps, 3U);
    EXPECT_FALSE(source->info().places_known);
    EXPECT_TRUE(has_warning(source->info(), "3 sweeps could not be read"));
    for (const std::size_t skipped : {5U, 8U}) {
      source = open_skipping(file);
      EXPECT_EQ(source->skip(skipped), std::max<std::size_t>(skipped, 7));
      EXPECT_EQ(source->next()->points[0].x(), static_cast<float>(std::max<std::size_t>(skipped, 7)) + 0.1F);
      EXPECT_EQ(source->current_index(), std::max<std::size_t>(skipped, 7));
    }
    source = open_scan_source(file);
    for (int k = 0; k < 4; ++k) source->next();
    expect_io_error([&] { source->next(); }, {"b.mcap", "chunk at byte", "CRC"});
    source->next();
    EXPECT_EQ(source->current_index(), 7U);
  }
}

TEST(DamagedRecordingTest, PlacesInASplitRecording) {
  const TempDir folder;
  folder.write("m/m_0.mcap", broken_mcap({3, 8}, true, false));
  folder.write("m/m_1.mcap", broken_mcap({8}, true, true, 10));
  auto source = open_skipping(folder / "m");
  EXPECT_EQ(source->size(), 20U);
  EXPECT_EQ(places_in(*source), (Places{{0, 0},
                                        {1, 1},
                                        {2, 2},
                                        {4, 4},
                                        {5, 5},
                                        {6, 6},
                                        {10, 10},
                                        {11, 11},
                                        {12, 12},
                                        {13, 13},
                                        {14, 14},
                                        {15, 15},
                                        {16, 16}}));
  EXPECT_EQ(source->info().bad_sweeps, 7U);
  source = open_skipping(folder / "m");
  EXPECT_EQ(source->skip(8), 10U);
}

TEST(DamagedRecordingTest, PlacesThatAreNotKnown) {
  const TempDir folder;
  const std::string warning = "only the sweeps before place 4";
  for (const auto& bytes : {broken_mcap({4}, false, false), broken_mcap({4, 7}, false, true)}) {
    const fs::path file = folder.write("b.mcap", bytes);
    auto source = open_skipping(file);
    EXPECT_TRUE(source->next());
    EXPECT_FALSE(source->info().places_known);
    places_in(*source);
    EXPECT_EQ(source->info().places_known, 4U);
    EXPECT_TRUE(has_warning(source->info(), warning));
    source = open_skipping(file);
    source->skip(6);
    EXPECT_TRUE(source->info().places_known);
  }
}

// Nobody misses the packets.
TEST(DamagedRecordingTest, AChunkWithoutTheTopicDoesNoHarm) {
  const TempDir folder;
  const auto sweeps = recorded(numbered_sweeps(2), MessageEncoding::kCdr);
  McapShape shape{"", 1, false};
  shape.message_index = true;
  std::string bytes = mcap_bytes(kTopics, {sweeps[0], {"/imu", 0, std::string(100, 'i')}, sweeps[1]}, shape);
  bytes[bytes.find("iiiii")] = 'j';
  const auto source = open_scan_source(folder.write("i.mcap", bytes));
  EXPECT_EQ(places_in(*source), (Places{{0, 0}, {1, 1}}));
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
