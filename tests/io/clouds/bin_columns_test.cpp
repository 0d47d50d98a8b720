// The number of columns of .bin files, where several fit their sizes.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"

namespace rilo::test {
namespace {

using Record = std::vector<float>;

constexpr std::size_t kRecords = 6000;  // a multiple of 4: any number of columns fits four

// A ring road of walls: x, y, z, intensity, ring, time.
std::vector<Record> sweep() {
  std::vector<Record> records;
  for (std::size_t i = 0; i < kRecords; ++i) {
    const float part = static_cast<float>(i) / static_cast<float>(kRecords);
    const float angle = 6.2831853F * part;
    const float range = 12 + 8 * std::cos(3 * angle);
    const auto ring = static_cast<float>(i % 16);
    const float shade = static_cast<float>(i % 97) / 97;
    records.push_back(
        {range * std::cos(angle), range * std::sin(angle), range * 0.03F * (ring - 8), shade, ring, 0.1F * part});
  }
  return records;
}

// The named columns of the records: x y z i r t, 1, 0.
std::string records_of(const std::vector<Record>& records, const std::string& columns) {
  const std::string names = "xyzirt";
  std::string bytes;
  for (const Record& record : records) {
    for (const char name : columns) {
      const float value = name == '1' ? 1.0F : name == '0' ? 0.0F : record[names.find(name)];
      bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
  return bytes;
}

std::vector<Record> shuffled(std::vector<Record> records) {
  std::shuffle(records.begin(), records.end(), std::mt19937(3));
  return records;
}

std::vector<Record> every_other_zero(std::vector<Record> records) {
  for (std::size_t i = 1; i < records.size(); i += 2) std::fill(records[i].begin(), records[i].end(), 0.0F);
  return records;
}

TEST(BinColumnsTest, OtherNumbersThanFourAreRefused) {
  const std::array<std::pair<const char*, const char*>, 5> others{
      {{"xyz", "3"}, {"xyzit", "5"}, {"xyzirt", "6"}, {"xyz1i000", "8"}, {"xyz1it r", "8"}}};
  for (const auto& [columns, count] : others) {
    std::string kept = columns;
    std::replace(kept.begin(), kept.end(), ' ', '0');
    for (const auto& records : {sweep(), shuffled(sweep())}) {
      SCOPED_TRACE(kept);
      const TempDir folder;
      const auto file = folder.write("a.bin", records_of(records, kept));
      expect_io_error([&] { open_scan_source(file); }, {"a.bin", "fit records of 3, 4, 5, 6",
                                                        std::string("look like records of ") + count, "--bin-fields"});
      SourceOptions options;
      options.bin_fields = "x,y,z";
      for (std::size_t i = 3; i < kept.size(); ++i) options.bin_fields += ",_";
      const auto source = open_scan_source(file, options);
      EXPECT_EQ(sweeps_of(*source).at(0).points.size(), kRecords);
      EXPECT_TRUE(source->info().warnings.empty());
    }
  }
}

TEST(BinColumnsTest, NamedColumnsThatTheNumbersDoNotLookLikeAreDoubted) {
  const TempDir folder;
  const auto file = folder.write("a.bin", records_of(sweep(), "xyzirt"));
  SourceOptions options;
  options.bin_fields = "x,y,z,intensity";
  const auto warnings = open_scan_source(file, options)->info().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("look like records of 6 columns, not 4"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("x,y,z,intensity,ring,time"), std::string::npos) << warnings[0];
  options.bin_fields = "x,y,z";  // half of a record of six
  EXPECT_EQ(open_scan_source(file, options)->info().warnings.size(), 1U);
}

TEST(BinColumnsTest, FourAreTaken) {
  for (const auto& records : {sweep(), shuffled(sweep()), every_other_zero(sweep())}) {
    for (const char* columns : {"xyzi", "xyz0", "xyz1", "xyzr"}) {
      const TempDir folder;
      const auto source = open_scan_source(folder.write("a.bin", records_of(records, columns)));
      EXPECT_EQ(sweeps_of(*source).at(0).points.size(), kRecords) << columns;
    }
  }
}

TEST(BinColumnsTest, FiveWithARing) {
  const TempDir folder;
  const auto sweeps = sweeps_of(*open_scan_source(folder.write("a.bin", records_of(sweep(), "xyzir"))));
  ASSERT_EQ(sweeps.at(0).rings.size(), kRecords);
  EXPECT_EQ(sweeps[0].rings[17], 1);
}

TEST(BinColumnsTest, NumbersThatTellNothing) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-10, 10);
  for (const std::size_t records : {std::size_t{12}, kRecords}) {
    std::vector<Record> noise(records);
    for (Record& record : noise) record = {any(random), any(random), any(random), any(random)};
    const TempDir folder;
    const auto source = open_scan_source(folder.write("a.bin", records_of(noise, "xyzi")));
    EXPECT_EQ(sweeps_of(*source).at(0).points.size(), records);
  }
}

}  // namespace
}  // namespace rilo::test
