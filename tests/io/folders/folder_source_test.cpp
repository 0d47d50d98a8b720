#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/folders/stamp_list.hpp"
#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

// A sweep that is known by its first point.
Sweep marked(float mark) {
  Sweep sweep;
  sweep.points = {{mark, 1, 1}, {2, 2, 2}};
  return sweep;
}

SourceOptions without_reading_ahead() {
  SourceOptions options;
  options.read_ahead = 0;
  return options;
}

std::vector<float> marks_of(ScanSource& source) {
  std::vector<float> marks;
  while (const auto sweep = source.next()) marks.push_back(sweep->points.at(0).x());
  return marks;
}

TEST(FolderSourceTest, PlainFolderInNaturalOrder) {
  const TempDir folder;
  for (const int i : {10, 9, 2, 100})
    write_pcd(folder / ("s" + std::to_string(i) + ".PCD"), marked(static_cast<float>(i)));
  folder.write("notes.md", "x");
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->info().kind, "folder");
  EXPECT_EQ(source->info().format, "pcd");
  EXPECT_EQ(marks_of(*source), (std::vector<float>{2, 9, 10, 100}));
}

TEST(FolderSourceTest, PlyFolderWithTimesInTheData) {
  const TempDir folder;
  write_ply(folder / "0.ply", small_sweep());
  write_ply(folder / "1.ply", small_sweep());
  const auto source = open_scan_source(folder.path(), without_reading_ahead());
  EXPECT_TRUE(source->info().has_point_times);  // promised by the header
  EXPECT_EQ(source->info().point_times, "field time");
  const auto sweep = source->next();
  EXPECT_EQ(sweep->times_s, small_sweep().times_s);
  EXPECT_EQ(sweep->rings, small_sweep().rings);
  EXPECT_EQ(source->info().point_times, "field time (float32), s since the sweep's stamp");
}

TEST(FolderSourceTest, PlyListsAreNoFields) {
  const TempDir folder;
  folder.write("0.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "property list uchar float time\nend_header\n1 2 3 1 0.5\n");
  const auto source = open_scan_source(folder.path(), without_reading_ahead());
  EXPECT_FALSE(source->info().has_point_times);
  EXPECT_FALSE(source->info().fields.at(3).used);
  EXPECT_TRUE(source->next()->times_s.empty());
}

TEST(FolderSourceTest, BinFieldsWithTime) {
  const TempDir folder;
  folder.write("0.bin", bytes_of<float>({1, 2, 3, 0, 4, 5, 6, 0.1F}));
  SourceOptions options;
  options.bin_fields = "x,y,z,time";
  const auto sweep = open_scan_source(folder.path(), options)->next();
  EXPECT_EQ(sweep->times_s, (std::vector<float>{0, 0.1F}));
  options.bin_fields = "x,y";
  EXPECT_THROW(open_scan_source(folder.path(), options), std::invalid_argument);
  options = {};
  options.assumed_rate_hz = 0;
  EXPECT_THROW(open_scan_source(folder.path(), options), std::invalid_argument);
  options = {};
  options.elevation_correction_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(open_scan_source(folder.path(), options), std::invalid_argument);
}

TEST(FolderSourceTest, StampsFromTheNamesOrTheTimesFile) {
  const TempDir folder;
  folder.write("n/1326652795280148.bin", bin_of(1));
  folder.write("n/1326652795480148.bin", bin_of(2));
  EXPECT_EQ(open_scan_source(folder / "n")->next()->stamp_ns, 1'326'652'795'280'148'000);
  EXPECT_NEAR(open_scan_source(folder / "n")->info().period_s, 0.2, 1e-6);
  folder.write("s/1326652795.5.bin", bin_of(1));
  EXPECT_EQ(open_scan_source(folder / "s")->next()->stamp_ns, 1'326'652'795'500'000'000);
  folder.write("d/1673400472138016708.pcd.bin", bin_of(1));
  EXPECT_EQ(open_scan_source(folder / "d")->next()->stamp_ns, 1'673'400'472'138'016'708);
  folder.write("t/1.bin", bin_of(1));
  folder.write("t/times.txt", "77.5\n");
  EXPECT_EQ(open_scan_source(folder / "t")->next()->stamp_ns, 77'500'000'000);
}

TEST(FolderSourceTest, NamesOfDecimalSecondsInTheOrderOfTime) {
  const TempDir folder;
  for (const char* name : {"1700000000.4234936", "1700000000.523506", "1700000000.6235182", "1700000000.05"}) {
    folder.write("s/" + std::string(name) + ".bin", bin_of(1));
  }
  const auto source = open_scan_source(folder / "s");
  std::vector<std::int64_t> hundredths;
  while (const auto sweep = source->next())
    hundredths.push_back((sweep->stamp_ns - 1'700'000'000'000'000'000) / 10'000'000);
  EXPECT_EQ(hundredths, (std::vector<std::int64_t>{5, 42, 52, 62}));
  EXPECT_FALSE(source->info().stamps_assumed);
}

TEST(FolderSourceTest, HiddenFilesAreNoSweeps) {
  const TempDir folder;
  folder.write("1.bin", bin_of(1));
  folder.write("._1.bin", "written by macOS");
  folder.write("._notes.pcd", "written by macOS");
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->size(), 1U);
  EXPECT_EQ(source->next()->points.size(), 2U);
}

std::vector<std::int64_t> stamps_of(const std::filesystem::path& path) {
  std::vector<std::int64_t> stamps;
  const auto source = open_scan_source(path);
  while (const auto sweep = source->next()) stamps.push_back(sweep->stamp_ns);
  return stamps;
}

TEST(FolderSourceTest, StampsFromTimestampsBesideOrAbove) {
  const std::vector<std::int64_t> kExpected{1'317'042'145'951'199'337, 1'317'042'146'054'503'000};
  for (const char* text :
       {"2011-09-26 13:02:25.951199337\n2011-09-26 13:02:26.054503000\n",
        "# ns\n1317042145951199337\n\n1317042146054503000\n", "1317042145.951199337\n1317042146.054503\n"}) {
    for (const char* place : {"d/lidar/timestamps.txt", "d/times.txt", "d/timestamps.txt"}) {
      SCOPED_TRACE(std::string(place) + ": " + text);
      const TempDir folder;
      folder.write("d/lidar/1.bin", bin_of(1));
      folder.write("d/lidar/2.bin", bin_of(2));
      folder.write(place, text);
      EXPECT_EQ(stamps_of(folder / "d/lidar"), kExpected);
      EXPECT_TRUE(open_scan_source(folder / "d/lidar")->info().warnings.empty());
    }
  }
}

TEST(FolderSourceTest, DatesWithoutLeadingZeros) {
  const TempDir folder;
  folder.write("1.bin", bin_of(1));
  folder.write("2.bin", bin_of(2));
  for (const char* text :
       {"2011-09-26 09:02:59.500\n2011-09-26 09:03:05.25\n", "2011-9-26 9:02:59.500\n2011-9-26 9:3:5.25\n",
        "2011-09-26 9:02:59.500\n2011-09-26 9:03:05.25\n"}) {
    folder.write("timestamps.txt", text);
    EXPECT_EQ(stamps_of(folder.path()),
              (std::vector<std::int64_t>{1'317'027'779'500'000'000, 1'317'027'785'250'000'000}))
        << text;
  }
  for (const char* line : {"2011-9-26 9:02:", "2011-9-26 9:02", "2011-9-26 9:02:x", "2011-9-26 9:02:99",
                           "2011-9-26 9:02: 5", "2011-9-026 13:02:25", "11-9-26 9:02:59"}) {
    folder.write("timestamps.txt", std::string(line) + "\n2011-9-26 9:03:05\n");
    EXPECT_TRUE(has_warning(open_scan_source(folder.path())->info(),
                            "timestamps.txt, line 1: '" + std::string(line) + "'; expected a date"))
        << line;
  }
}

TEST(FolderSourceTest, TimestampsThatDoNotFitAreNamed) {
  const TempDir folder;
  folder.write("d/lidar/1.bin", bin_of(1));
  folder.write("d/timestamps.txt", "0.5\n0.6\n");
  folder.write("d/lidar/timestamps.txt", "noon\n");
  const auto info = open_scan_source(folder / "d/lidar")->info();
  EXPECT_TRUE(info.stamps_assumed);
  EXPECT_TRUE(has_warning(info, "d/timestamps.txt: 2 stamps for 1 sweep"));
  EXPECT_TRUE(has_warning(info, "lidar/timestamps.txt, line 1: 'noon'"));
  EXPECT_TRUE(has_warning(info, "no timestamps found; assuming 10 Hz"));
  // A KITTI sequence has its times beside velodyne/; what lies above that is of other data.
  folder.write("s/00/velodyne/1.bin", bin_of(1));
  folder.write("s/timestamps.txt", "0.5\n");
  EXPECT_EQ(stamps_of(folder / "s/00"), std::vector<std::int64_t>{0});
  folder.write("s/00/timestamps.txt", "0.5\n");
  EXPECT_EQ(stamps_of(folder / "s/00"), std::vector<std::int64_t>{500'000'000});
}

TEST(FolderSourceTest, SingleFile) {
  const TempDir folder;
  write_ply(folder / "a.ply", marked(4));
  const auto source = open_scan_source(folder / "a.ply");
  EXPECT_EQ(source->info().kind, "file");
  EXPECT_EQ(source->size(), 1U);
  EXPECT_EQ(marks_of(*source), std::vector<float>{4});
  expect_io_error([&] { open_scan_source(folder.write("a.csv", "")); }, {"a.csv", "'.csv'", ".bin, .pcd or .ply"});
  expect_io_error([&] { open_scan_source(folder / "none"); }, {"none", "no such file or folder"});
  expect_io_error([&] { open_scan_source("/dev/null"); }, {"neither a folder nor a file"});
}

TEST(FolderSourceTest, FoldersThatAreNoData) {
  const TempDir folder;
  std::filesystem::create_directory(folder / "empty");
  expect_io_error([&] { open_scan_source(folder / "empty"); },
                  {"empty", "no sweeps here (.bin, .pcd, .ply), 0 other files"});
  std::filesystem::create_directory(folder / "seq");
  std::filesystem::create_directory(folder / "seq/velodyne");
  expect_io_error([&] { open_scan_source(folder / "seq"); }, {"seq/velodyne", "no sweeps here"});
  folder.write("mixed/a.bin", "");
  folder.write("mixed/b.bin", "");
  folder.write("mixed/c.pcd", "");
  expect_io_error([&] { open_scan_source(folder / "mixed"); }, {"mixed", "2 .bin and 1 .pcd"});
  folder.write("captures/b.pcap", "");
  folder.write("captures/notes.txt", "");
  expect_io_error([&] { open_scan_source(folder / "captures"); }, {"2 other files", "itself: ", "captures/b.pcap"});
  std::filesystem::create_directories(folder / "root/sequences/00");
  expect_io_error([&] { open_scan_source(folder / "root/sequences"); }, {"the folders 00", "the sweeps themselves"});
  folder.write("drive/lidar/data/0.pcd", "");
  expect_io_error([&] { open_scan_source(folder / "drive"); },
                  {"no sweeps here", "subfolder lidar/data/ has 1 .pcd", "Give that subfolder"});
  expect_io_error([&] { open_scan_source(folder / "drive/lidar"); }, {"subfolder data/ has 1 .pcd"});
}

TEST(FolderSourceTest, BadSweepFailsAndTheNextIsRead) {
  const TempDir folder;
  write_sequence(folder, 3, "");
  folder.write("velodyne/1.bin", "12345");
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->next()->points[0].x(), 0);
  expect_io_error([&] { source->next(); }, {"velodyne/1.bin", "5 bytes", "records of 16 bytes"});
  EXPECT_EQ(source->current_index(), 1U);
  EXPECT_EQ(source->next()->points[0].x(), 2);
  EXPECT_FALSE(source->next());
}

TEST(FolderSourceTest, BadSweepIsSkippedWhenTold) {
  const TempDir folder;
  write_sequence(folder, 4, "");
  folder.write("velodyne/1.bin", "12345");
  folder.write("velodyne/3.bin", "12345");
  SourceOptions options;
  options.on_bad_sweep = OnBadSweep::kSkip;
  const auto source = open_scan_source(folder.path(), options);
  source->next();
  EXPECT_EQ(source->next()->stamp_ns, 200'000'000);
  EXPECT_EQ(source->current_index(), 2U);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->info().bad_sweeps, 2U);
  EXPECT_TRUE(has_warning(source->info(), "velodyne/1.bin"));
  EXPECT_TRUE(has_warning(source->info(), "2 sweeps could not be read"));
}

TEST(FolderSourceTest, WithoutStampsNumbersTellWhichSweepsAreMissing) {
  const auto steps_of = [](const std::vector<std::string>& names) {
    const TempDir folder;
    for (const std::string& name : names) folder.write(name, bytes_of<float>({1, 2, 3, 4}));
    SourceOptions options;
    options.assumed_rate_hz = 20;
    const auto source = open_scan_source(folder.path(), options);
    std::vector<std::int64_t> steps;
    std::int64_t before = source->next()->stamp_ns;
    while (const auto sweep = source->next()) {
      steps.push_back((sweep->stamp_ns - before) / 50'000'000);
      before = sweep->stamp_ns;
    }
    EXPECT_TRUE(source->info().stamps_assumed);
    return steps;
  };
  using Steps = std::vector<std::int64_t>;
  EXPECT_EQ(steps_of({"7.bin", "8.bin", "11.bin", "12.bin"}), (Steps{1, 3, 1}));
  EXPECT_EQ(steps_of({"scan_000.bin", "scan_005.bin", "scan_015.bin", "scan_020.bin"}), (Steps{1, 2, 1}));
  EXPECT_EQ(steps_of({"0001_a.bin", "0002_a.bin", "0004_a.bin"}), (Steps{1, 2}));
  // Numbers that may mean something else.
  EXPECT_EQ(steps_of({"1.bin", "2.bin", "40.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"a1.bin", "b2.bin", "b4.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"a.bin", "b.bin"}), (Steps{1}));
  EXPECT_EQ(steps_of({"1_1.bin", "1_2.bin", "2_1.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"1234567890.bin", "1234567891.bin", "1234567893.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"01.bin", "1.bin", "3.bin"}), (Steps{1, 1}));
}

TEST(FolderSourceTest, EmptyAndNanSweepsAreSweeps) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const TempDir folder;
  folder.write("0.bin", "");
  folder.write("1.bin", bytes_of<float>({kNan, kNan, kNan, kNan}));
  SourceOptions options;
  options.point_times = PointTimes::kAzimuth;
  options.elevation_correction_deg = 0.2;
  const auto source = open_scan_source(folder.path(), options);
  EXPECT_TRUE(source->next()->points.empty());
  const auto sweep = source->next();
  ASSERT_EQ(sweep->points.size(), 1U);
  EXPECT_TRUE(std::isnan(sweep->points[0].x()));
  EXPECT_EQ(sweep->times_s, std::vector<float>{0});
}

TEST(FolderSourceTest, SkipReadsNothing) {
  const TempDir folder;
  write_sequence(folder, 5, "");
  folder.write("velodyne/1.bin", "12345");
  for (const std::size_t read_ahead : {0U, 3U}) {
    SourceOptions options;
    options.read_ahead = read_ahead;
    const auto source = open_scan_source(folder.path(), options);
    EXPECT_EQ(source->skip(2), 2U);
    EXPECT_EQ(source->next()->points[0].x(), 2);
    EXPECT_EQ(source->current_index(), 2U);
    EXPECT_EQ(source->skip(1), 1U);
    EXPECT_EQ(source->next()->points[0].x(), 4);
    EXPECT_EQ(source->skip(9), 0U);
    EXPECT_FALSE(source->next());
  }
}

TEST(StampListTest, MicrosecondsThatDoNotFitAreNone) {
  EXPECT_EQ(detail::parse_long_stamp("1700000000123456"), 1'700'000'000'123'456'000);
  EXPECT_FALSE(detail::parse_long_stamp("9999999999999999"));
}

}  // namespace
}  // namespace rilo::test
