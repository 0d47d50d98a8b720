#include <string>
#include <vector>

#include "io/folders/ground_truth.hpp"
#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

TEST(SequenceSourceTest, KittiSequence) {
  const TempDir folder;
  write_sequence(folder, 12, "0\n0.1\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n0.8\n0.9\n1.000000001\n1.1\n");
  folder.write("calib.txt", "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->size(), 12U);
  const SourceInfo info = source->info();
  EXPECT_EQ(info.kind, "kitti");
  EXPECT_EQ(info.format, "bin");
  EXPECT_EQ(info.path, folder.path());
  EXPECT_FALSE(info.has_point_times);
  EXPECT_FALSE(info.stamps_assumed);
  EXPECT_NEAR(info.period_s, 0.1, 1e-9);
  EXPECT_TRUE(info.T_cam_lidar);
  EXPECT_TRUE(info.warnings.empty());
  std::int64_t last = -1;
  for (int i = 0; i < 12; ++i) {
    const auto sweep = source->next();
    ASSERT_TRUE(sweep);
    EXPECT_EQ(sweep->points.at(0).x(), static_cast<float>(i));  // 2 before 10
    EXPECT_GT(sweep->stamp_ns, last);
    EXPECT_EQ(source->current_index(), static_cast<std::size_t>(i));
    EXPECT_EQ(source->current_name(), (folder / ("velodyne/" + std::to_string(i) + ".bin")).string());
    if (i == 10) {
      EXPECT_EQ(sweep->stamp_ns, 1'000'000'001);
    }
    last = sweep->stamp_ns;
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST(SequenceSourceTest, WithoutStampsTheRateIsAssumed) {
  const TempDir folder;
  write_sequence(folder, 3, "");
  SourceOptions options;
  options.rate_hz = 20;
  const auto source = open_scan_source(folder.path(), options);
  EXPECT_TRUE(source->info().stamps_assumed);
  EXPECT_TRUE(has_warning(source->info(), "no timestamps found; assuming 20 Hz (change with --rate)"));
  source->next();
  EXPECT_EQ(source->next()->stamp_ns, 50'000'000);
}

TEST(SequenceSourceTest, StampsOutOfOrderAndGapsAreReported) {
  const TempDir folder;
  write_sequence(folder, 6, "0\n0.1\n0.1\n0.2\n0.6\n0.7\n");
  const auto source = open_scan_source(folder.path());
  while (source->next()) {
  }
  const SourceInfo info = source->info();
  EXPECT_EQ(info.faults.duplicates + info.faults.repeated, 1U);
  EXPECT_TRUE(has_warning(info, "a gap of 0.400 s before it (3 missing)"));
}

// As of KITTI raw where the stamps are rounded to 10 ms: steps of 0.1 s, and now and then of 0.11 s.
TEST(SequenceSourceTest, ThePeriodOfRoundedStampsIsTheirMean) {
  const TempDir folder;
  std::string stamps;
  for (const char* stamp : {"0", "0.10", "0.21", "0.31", "0.41", "0.52", "0.62", "0.72", "1.85", "1.86"}) {
    stamps += std::string(stamp) + "\n";
  }
  write_sequence(folder, 10, stamps);
  const auto source = open_scan_source(folder.path());
  EXPECT_NEAR(source->info().period_s, 0.72 / 7, 1e-9);  // without the gap and the burst behind it
}

TEST(SequenceSourceTest, SequenceErrors) {
  const TempDir folder;
  write_sequence(folder, 3, "0\n0.1\n");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"times.txt", "2 stamps", "each of the 3 sweeps"});
  folder.write("times.txt", "0\nlater\n0.2\n");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"times.txt", "line 2", "'later'"});
  folder.write("times.txt", "0\n0.1\n0.2\n");
  folder.write("calib.txt", "Tr: 1 2 3\n");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"calib.txt", "line 1", "3 values"});
}

void write_drive_folder(const TempDir& folder, const std::string& meta) {
  for (const char* name : {"000000", "000001"}) {
    folder.write(std::string("velodyne/") + name + ".bin", bytes_of<float>({-1, 0.1F, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}));
    folder.write(std::string("times_pt/") + name + ".bin", bytes_of<float>({0, 0.5F, 1}));
  }
  folder.write("times.txt", "1.0\n1.3\n");
  folder.write("meta.json", meta);
}

TEST(SequenceSourceTest, DriveSimulator) {
  const TempDir folder;
  write_drive_folder(folder, R"({"rate_hz": 5})");
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->info().kind, "drive simulator");
  EXPECT_TRUE(source->info().has_point_times);
  EXPECT_NEAR(source->info().period_s, 0.2, 1e-12);
  const auto sweep = source->next();
  EXPECT_EQ(sweep->stamp_ns, 1'000'000'000);
  ASSERT_EQ(sweep->times_s.size(), 3U);
  EXPECT_FLOAT_EQ(sweep->times_s[0], 0);
  EXPECT_FLOAT_EQ(sweep->times_s[1], 0.1F);
  EXPECT_FLOAT_EQ(sweep->times_s[2], 0.2F);
}

// A drive written with our own writers.
TEST(SequenceSourceTest, WrittenDriveComesBack) {
  const TempDir folder;
  std::filesystem::create_directory(folder / "velodyne");
  std::filesystem::create_directory(folder / "times_pt");
  const Sweep written = small_sweep();
  std::vector<float> fractions;
  for (const float time : written.times_s) fractions.push_back(time * 10);
  write_kitti_bin(folder / "velodyne/000000.bin", written);
  write_floats(folder / "times_pt/000000.bin", fractions);
  write_stamps(folder / "times.txt", {1'500'000'001});
  SE3 pose = SE3::Identity();
  pose.translation() << 1, 2, 3;
  write_kitti_poses(folder / "poses_mid.txt", std::vector<SE3>{pose});
  const auto sweep = open_scan_source(folder.path())->next();
  EXPECT_EQ(sweep->points, written.points);
  EXPECT_EQ(sweep->intensities, written.intensities);
  EXPECT_EQ(sweep->stamp_ns, 1'500'000'001);
  for (std::size_t i = 0; i < fractions.size(); ++i) EXPECT_NEAR(sweep->times_s.at(i), written.times_s[i], 1e-7F);
  const auto truth = read_ground_truth(folder.path(), PoseInstant::kMid);
  EXPECT_EQ(truth->T_world_lidar.at(0).matrix(), pose.matrix());
}

TEST(SequenceSourceTest, DriveSimulatorWithoutItsTimesOrFromAzimuth) {
  const TempDir folder;
  write_drive_folder(folder, R"({"rate_hz": 5})");
  SourceOptions options;
  options.point_times = PointTimes::kNone;
  auto source = open_scan_source(folder.path(), options);
  EXPECT_FALSE(source->info().has_point_times);
  EXPECT_TRUE(source->next()->times_s.empty());
  // The sensor faces forward half a period after the stamp; the same instants come out.
  options.point_times = PointTimes::kAzimuth;
  source = open_scan_source(folder.path(), options);
  const auto sweep = source->next();
  EXPECT_EQ(sweep->stamp_ns, 1'100'000'000);
  EXPECT_NEAR(sweep->times_s[1], 0, 1e-6F);
  EXPECT_NEAR(sweep->times_s[0], -0.1F, 0.005F);
}

TEST(SequenceSourceTest, DriveSimulatorErrors) {
  const TempDir folder;
  write_drive_folder(folder, "{");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"meta.json", "not a JSON object"});
  folder.write("meta.json", R"({"rate_hz": "fast"})");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"meta.json", "rate_hz"});
  folder.write("meta.json", R"({"rate_hz": 0})");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"meta.json", "rate_hz"});
  folder.write("meta.json", "{}");
  EXPECT_NEAR(open_scan_source(folder.path())->info().period_s, 0.3, 1e-9);  // from times.txt
  folder.write("times_pt/000000.bin", bytes_of<float>({0, 1}));
  expect_io_error([&] { open_scan_source(folder.path())->next(); }, {"times_pt/000000.bin", "8 bytes", "3 float32"});
  folder.write("times_pt/000000.bin", bytes_of<float>({0, 1, 7}));
  expect_io_error([&] { open_scan_source(folder.path())->next(); }, {"times_pt/000000.bin", "from 0 to 7"});
  std::filesystem::rename(folder / "times_pt/000001.bin", folder / "times_pt/000002.bin");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"000002.bin", "beside sweep 000001.bin"});
  std::filesystem::remove(folder / "times_pt/000002.bin");
  expect_io_error([&] { open_scan_source(folder.path()); }, {"times_pt", "1 file", "2 sweeps"});
}

TEST(SequenceSourceTest, AzimuthTimesOnlyWhenTold) {
  const TempDir folder;
  write_sequence(folder, 3, "0\n0.2\n0.4\n");
  EXPECT_TRUE(open_scan_source(folder.path())->next()->times_s.empty());
  SourceOptions options;
  options.point_times = PointTimes::kAzimuth;
  const auto source = open_scan_source(folder.path(), options);
  EXPECT_TRUE(source->info().has_point_times);
  EXPECT_NE(source->info().point_times.find("azimuth, clockwise, period 0.2"), std::string::npos);
  source->next();
  const auto sweep = source->next();
  EXPECT_EQ(sweep->stamp_ns, 200'000'000);
  EXPECT_NEAR(sweep->times_s[0], -0.2F / 8, 1e-6F);  // (1, 1): 45 degrees to the left, an eighth of a turn early
}

}  // namespace
}  // namespace rilo::test
