// Folders as data sets are published.
#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

void write_kitti_raw(const TempDir& folder, const std::string& dates) {
  for (const char* name : {"0000000000", "0000000001", "0000000003"}) {
    folder.write(std::string("day/drive_0001_sync/velodyne_points/data/") + name + ".bin", bin_of(1));
  }
  folder.write("day/drive_0001_sync/velodyne_points/timestamps.txt", dates);
}

constexpr const char* kDates =
    "2011-09-26 13:02:25.951199337\n2011-09-26 13:02:26.054503000\n2011-09-26 13:02:26.157000000\n"
    "2011-09-26 13:02:26.260000001\n";

TEST(DatasetLayoutsTest, KittiRaw) {
  const TempDir folder;
  write_kitti_raw(folder, kDates);
  folder.write("day/calib_velo_to_cam.txt", "calib_time: x\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 0.2 0.3\n");
  folder.write("day/calib_cam_to_cam.txt", "R_rect_00: 1 0 0 0 1 0 0 0 1\nR_rect_01: 9\n");
  const auto source = open_scan_source(folder / "day/drive_0001_sync");
  EXPECT_EQ(source->info().kind, "kitti raw");
  EXPECT_EQ(source->size(), 3U);
  EXPECT_EQ(source->next()->stamp_ns, 1'317'042'145'951'199'337);
  EXPECT_EQ(source->next()->stamp_ns, 1'317'042'146'054'503'000);
  EXPECT_EQ(source->next()->stamp_ns, 1'317'042'146'260'000'001);  // sweep 2 is missing, its line is not
  ASSERT_TRUE(source->info().T_cam_lidar);
  EXPECT_EQ(source->info().T_cam_lidar->translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(source->info().T_cam_lidar->linear()(0, 1), -1);
}

TEST(DatasetLayoutsTest, KittiRawWithADamagedCalibration) {
  const TempDir folder;
  write_kitti_raw(folder, kDates);
  const std::string velo = "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 0.2 0.3\n";
  const std::string cam = "R_rect_00: 1 0 0 0 1 0 0 0 1\n";
  const auto open = [&] { open_scan_source(folder / "day/drive_0001_sync"); };
  folder.write("day/calib_cam_to_cam.txt", cam);
  for (const char* text : {"R: 0 0 0 0 0 0 0 0 0\nT: 1 2 3\n", "R: 0 -1 0 0 0 -1 -1 0 0\nT: 1 2 3\n",
                           "R: nan -1 0 0 0 -1 1 0 0\nT: 1 2 3\n", "R: 0 -1 0 0 0 -1 1 0 0\nT: 1 nan 3\n",
                           "R: 0 -1 0 0 0 -1 1 0 0\n", "R: 0 -1 0\nT: 1 2 3\n"}) {
    folder.write("day/calib_velo_to_cam.txt", text);
    expect_io_error(open, {"calib_velo_to_cam.txt: no transform", "R: with the 9 numbers of a rotation"});
  }
  folder.write("day/calib_velo_to_cam.txt", velo);
  for (const char* text :
       {"R_rect_00: 2 0 0 0 1 0 0 0 1\n", "R_rect_00: 1 0 0 0 1 0\n", "R_rect_01: 1 0 0 0 1 0 0 0 1\n"}) {
    folder.write("day/calib_cam_to_cam.txt", text);
    expect_io_error(open, {"calib_cam_to_cam.txt: no rotation", "R_rect_00: with the 9 numbers of a rotation"});
  }
  folder.write("day/calib_cam_to_cam.txt", cam);
  open();
}

TEST(DatasetLayoutsTest, KittiRawWithWrongDates) {
  const TempDir folder;
  write_kitti_raw(folder, "2011-09-26 13:02:25.951199337\n2011-13-26 13:02:25.9\n");
  expect_io_error([&] { open_scan_source(folder / "day/drive_0001_sync"); },
                  {"timestamps.txt, line 2", "'2011-13-26 13:02:25.9'"});
  write_kitti_raw(folder, "2011-09-26 13:02:25.951199337\n");
  expect_io_error([&] { open_scan_source(folder / "day/drive_0001_sync"); }, {"1 stamp", "0000000001.bin"});
  for (const char* line : {"2011-09-26", "2011-09-26 25:02:25.9", "2011-09-26 13:02:99", "2011-09-26 13:02:x", "x"}) {
    write_kitti_raw(folder, line);
    expect_io_error([&] { open_scan_source(folder / "day/drive_0001_sync"); }, {"timestamps.txt, line 1"});
  }
}

TEST(DatasetLayoutsTest, Mulran) {
  const TempDir folder;
  Bytes whole;
  for (std::size_t i = 0; i < std::size_t{64} * 1024; ++i) {
    whole.put(static_cast<float>(i % 64) + 1).put(2.0F).put(3.0F).put(9.0F);
  }
  folder.write("sensor_data/Ouster/1561000444390857630.bin", whole.text);
  folder.write("sensor_data/Ouster/1561000444490857630.bin", whole.text);
  folder.write("sensor_data/Ouster/1561000444590857630.bin", bin_of(3));  // broken ones occur
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(source->info().kind, "mulran");
  const auto sweep = source->next();
  EXPECT_EQ(sweep->stamp_ns, 1'561'000'444'390'857'630);
  ASSERT_EQ(sweep->times_s.size(), 65536U);
  EXPECT_EQ(sweep->times_s[63], 0);
  EXPECT_FLOAT_EQ(sweep->times_s[64], 0.1F / 1024);
  EXPECT_FLOAT_EQ(sweep->times_s[65535], 0.1F * 1023 / 1024);
  EXPECT_FALSE(source->next()->times_s.empty());
  EXPECT_TRUE(source->next()->times_s.empty());
}

TEST(DatasetLayoutsTest, FiveFloats) {
  const TempDir folder;
  const std::string five = bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  folder.write("a/0.bin", five);
  folder.write("a/1.bin", five + five);
  const auto sweep = open_scan_source(folder / "a")->next();
  EXPECT_EQ(sweep->points, (std::vector<Eigen::Vector3f>{{1, 2, 3}, {6, 7, 8}}));
  EXPECT_EQ(sweep->rings, (std::vector<std::uint16_t>{5, 10}));
  // 80 bytes are four records of five or five of four: the name decides.
  folder.write("b/0.bin", five + five);
  EXPECT_EQ(open_scan_source(folder / "b")->next()->points.size(), 5U);
  folder.write("c/0.pcd.bin", five + five);
  EXPECT_EQ(open_scan_source(folder / "c")->next()->points.size(), 4U);
  // 20 bytes that are four columns and a surplus: what would be the ring is none.
  folder.write("e/0.bin", bytes_of<float>({1, 2, 3, 0.4F, 5.5F}));
  expect_io_error([&] { open_scan_source(folder / "e")->next(); }, {"20 bytes", "bin_fields"});
  folder.write("d/0.bin", five.substr(0, 33));
  expect_io_error([&] { open_scan_source(folder / "d")->next(); }, {"33 bytes", "bin_fields"});
}

}  // namespace
}  // namespace rilo::test
