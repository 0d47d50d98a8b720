// Folders and files of sweeps, with what may be wrong with them.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

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
  options.rate_hz = 0;
  EXPECT_THROW(open_scan_source(folder.path(), options), std::invalid_argument);
  options = {};
  options.elevation_correction_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(open_scan_source(folder.path(), options), std::invalid_argument);
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

TEST(FolderSourceTest, SingleFile) {
  const TempDir folder;
  write_ply(folder / "a.ply", marked(4));
  const auto source = open_scan_source(folder / "a.ply");
  EXPECT_EQ(source->info().kind, "file");
  EXPECT_EQ(source->size(), 1U);
  EXPECT_EQ(marks_of(*source), std::vector<float>{4});
  expect_io_error([&] { open_scan_source(folder.write("a.csv", "")); },
                  {"a.csv", "'.csv'", "a sweep (.bin, .pcd, .ply) or a recording", "field \"time\""});
  expect_io_error([&] { open_scan_source(folder.write("a.bag.gz", "")); }, {"a.bag.gz", "Unpack it"});
  expect_io_error([&] { open_scan_source(folder.write("a.bag.active", "")); }, {"a.bag.active", "rosbag reindex"});
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
  expect_io_error([&] { open_scan_source(folder / "captures"); }, {"captures/b.pcap", "libpcap"});
  folder.write("clouds/0.LAZ", "");
  folder.write("clouds/1.laz", "");
  folder.write("clouds/notes", "");
  expect_io_error([&] { open_scan_source(folder / "clouds"); },
                  {"3 other files, mostly .laz", "Sweeps in other formats: convert them to .pcd"});
  folder.write("dumps/000000/cloud.pcd", "");
  folder.write("dumps/000001/cloud.pcd", "");
  expect_io_error([&] { open_scan_source(folder / "dumps"); },
                  {"subfolder 000000/ has 1 .pcd", "of all the subfolders into one folder"});
  folder.write("arrays/000000.npy", "");
  expect_io_error([&] { open_scan_source(folder / "arrays"); },
                  {"1 other file", "numpy.load(\"000000.npy\")", "Python"});
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

}  // namespace
}  // namespace rilo::test
