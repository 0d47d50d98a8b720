// What was asked for and makes no difference, and what the data have and nobody asked for.
#include <string>

#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

TEST(UnusedOptionsTest, OptionsThatMakeNoDifferenceAreNamed) {
  const TempDir folder;
  Sweep sweep;
  sweep.points = {{1, 2, 3}};
  write_ply(folder / "1700000000000000000.ply", sweep);
  write_ply(folder / "1700000000100000000.ply", sweep);
  SourceOptions options;
  options.topic = "/points";
  options.sensor_file = "nothere.json";
  options.bin_fields = "x,y,z";
  options.rate_hz = 20;
  options.spin_direction = SpinDirection::kCounterClockwise;
  options.point_time_unit = PointTimeUnit::kSeconds;
  const auto info = open_scan_source(folder.path(), options)->info();
  for (const char* option : {"--topic '/points'", "--sensor-file 'nothere.json'", "--bin-fields x,y,z", "--rate 20",
                             "--spin", "--point-time-unit"}) {
    EXPECT_TRUE(has_warning(info, std::string(option) + " is ignored")) << option;
  }
  EXPECT_EQ(info.warnings.size(), 6U);
  EXPECT_TRUE(open_scan_source(folder.path())->info().warnings.empty());
}

TEST(UnusedOptionsTest, OptionsThatMakeADifferenceAreNot) {
  const TempDir folder;
  Sweep sweep;
  sweep.points = {{1, 2, 3}, {2, 3, 4}};
  SourceOptions options;
  options.rate_hz = 1000;
  options.point_times = PointTimes::kAzimuth;
  options.spin_direction = SpinDirection::kCounterClockwise;
  const auto warnings = [&](const std::filesystem::path& path) {
    return open_scan_source(path, options)->info().warnings;
  };
  std::filesystem::create_directory(folder / "alone");
  std::filesystem::create_directory(folder / "unstamped");
  write_ply(folder / "alone/1700000000000000000.ply", sweep);
  EXPECT_TRUE(warnings(folder / "alone").empty());  // its length
  write_ply(folder / "unstamped/a.ply", sweep);
  write_ply(folder / "unstamped/b.ply", sweep);
  EXPECT_FALSE(open_scan_source(folder / "unstamped", options)->info().warnings.empty());
  EXPECT_FALSE(has_warning(open_scan_source(folder / "unstamped", options)->info(), "is ignored"));
  options.rate_hz = 1000.1;
  EXPECT_THROW(open_scan_source(folder / "alone", options), std::invalid_argument);
}

TEST(UnusedOptionsTest, FieldsOfTheFirstSweep) {
  const TempDir folder;
  std::string header = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (const char* field : {"x", "y", "z", "ts", "ring"}) header += std::string("property float ") + field + "\n";
  folder.write("0.ply", header + "end_header\n1 2 3 4 5\n");
  const auto info = open_scan_source(folder.path())->info();
  ASSERT_EQ(info.fields.size(), 5U);
  EXPECT_EQ(info.fields[3].name, "ts");
  EXPECT_FALSE(info.fields[3].used);
  EXPECT_TRUE(info.fields[3].may_hold_times);
  EXPECT_TRUE(info.fields[4].used);
  EXPECT_TRUE(has_warning(info, "field 'ts' is not used; if it holds the points' times: --time-field ts"));
}

}  // namespace
}  // namespace rilo::test
