#include "io/folders/ground_truth.hpp"

#include "io/io_test_util.hpp"

namespace rilo::test {
namespace {

// LiDAR forward is camera z, LiDAR left is camera -x, LiDAR up is camera -y.
constexpr const char* kCalib = "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n";

void write_sweeps(const TempDir& folder, const std::string& where, int count) {
  for (int i = 0; i < count; ++i) folder.write(where + "/velodyne/" + std::to_string(i) + ".bin", "");
}

TEST(GroundTruthTest, NothingThere) {
  const TempDir folder;
  write_sweeps(folder, "d", 2);
  EXPECT_FALSE(read_ground_truth(folder / "d", PoseInstant::kMid));
  EXPECT_FALSE(read_ground_truth(folder / "d/velodyne/0.bin", PoseInstant::kMid));
  EXPECT_FALSE(read_ground_truth(folder / "none", PoseInstant::kMid));
}

TEST(GroundTruthTest, DriveSimulatorHasAllInstants) {
  const TempDir folder;
  write_sweeps(folder, "d", 1);
  folder.write("d/poses.txt", kitti_row(9, 0, 0));
  folder.write("d/calib.txt", kCalib);
  for (const auto instant : {PoseInstant::kStart, PoseInstant::kMid, PoseInstant::kEnd}) {
    const std::string name(to_string(instant));
    EXPECT_EQ(parse_pose_instant(name), instant);
    folder.write("d/poses_" + name + ".txt", kitti_row(static_cast<double>(instant), 0, 0));
  }
  for (const auto instant : {PoseInstant::kStart, PoseInstant::kMid, PoseInstant::kEnd}) {
    const auto truth = read_ground_truth(folder / "d", instant);
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->T_world_lidar.at(0).translation().x(), static_cast<double>(instant));
    EXPECT_EQ(truth->instant, to_string(instant));
    EXPECT_TRUE(truth->warnings.empty());
  }
  EXPECT_FALSE(parse_pose_instant("middle"));
}

TEST(GroundTruthTest, LidarFrameFile) {
  const TempDir folder;
  write_sweeps(folder, "d", 3);
  folder.write("d/calib.txt", kCalib);
  folder.write("d/poses_velo.txt", kitti_row(1, 2, 3) + kitti_row(4, 5, 6));
  const auto truth = read_ground_truth(folder / "d", PoseInstant::kMid);
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->T_world_lidar.size(), 2U);
  EXPECT_EQ(truth->T_world_lidar[1].translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(truth->instant, "stamp");
  ASSERT_EQ(truth->warnings.size(), 1U);
  EXPECT_NE(truth->warnings[0].find("2 poses for 3 sweeps"), std::string::npos);
  EXPECT_EQ(read_ground_truth(folder / "d", PoseInstant::kEnd)->warnings.size(), 2U);
}

TEST(GroundTruthTest, CameraFrameComesToTheLidarFrame) {
  const TempDir folder;
  write_sweeps(folder, "d", 1);
  folder.write("d/calib.txt", kCalib);
  folder.write("d/poses.txt", kitti_row(1, 2, 3));
  const auto truth = read_ground_truth(folder / "d", PoseInstant::kMid);
  ASSERT_TRUE(truth);
  // Camera right 1, down 2, forward 3 is LiDAR forward 3, left -1, up -2.
  EXPECT_TRUE(truth->T_world_lidar[0].translation().isApprox(Eigen::Vector3d(3, -1, -2)));
  EXPECT_TRUE(truth->warnings.empty());
  std::filesystem::remove(folder / "d/calib.txt");
  const auto plain = read_ground_truth(folder / "d", PoseInstant::kMid);
  EXPECT_EQ(plain->T_world_lidar[0].translation(), Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(plain->warnings.size(), 1U);
  EXPECT_NE(plain->warnings[0].find("LiDAR frame"), std::string::npos);
}

TEST(GroundTruthTest, AnotherTimeOfTheSweepIsSaid) {
  const TempDir folder;
  write_sweeps(folder, "d", 1);
  folder.write("d/calib.txt", kCalib);
  folder.write("d/poses.txt", kitti_row(1, 2, 3));
  folder.write("d/meta.json", R"({"reference_time": "end of the sweep"})");
  const auto truth = read_ground_truth(folder / "d", PoseInstant::kMid);
  EXPECT_EQ(truth->instant, "end");
  ASSERT_EQ(truth->warnings.size(), 1U);
  EXPECT_EQ(truth->warnings[0], "poses.txt is at the end, not at the mid of the sweeps");
  EXPECT_TRUE(read_ground_truth(folder / "d", PoseInstant::kEnd)->warnings.empty());
  for (const char* other : {R"({"reference_time": "GPS"})", R"({"rate_hz": 10})", "[]", "none"}) {
    folder.write("d/meta.json", other);
    EXPECT_EQ(read_ground_truth(folder / "d", PoseInstant::kMid)->instant, "stamp");
  }
}

TEST(GroundTruthTest, KittiOdometryLayout) {
  const TempDir folder;
  write_sweeps(folder, "sequences/07", 1);
  folder.write("poses/07.txt", kitti_row(0, 0, 5) + kitti_row(0, 0, 6));
  expect_io_error([&] { read_ground_truth(folder / "sequences/07", PoseInstant::kMid); },
                  {"07.txt", "camera frame", "calib.txt"});
  folder.write("sequences/07/calib.txt", kCalib);
  for (const char* path : {"sequences/07", "sequences/07/"}) {
    const auto truth = read_ground_truth(folder / path, PoseInstant::kMid);
    ASSERT_TRUE(truth);
    ASSERT_EQ(truth->T_world_lidar.size(), 1U);  // as many as sweeps
    EXPECT_TRUE(truth->T_world_lidar[0].translation().isApprox(Eigen::Vector3d(5, 0, 0)));
    EXPECT_EQ(truth->warnings.size(), 1U);
  }
}

TEST(GroundTruthTest, MalformedFile) {
  const TempDir folder;
  write_sweeps(folder, "d", 1);
  folder.write("d/poses_mid.txt", "1 2 3\n");
  expect_io_error([&] { read_ground_truth(folder / "d", PoseInstant::kMid); }, {"poses_mid.txt", "line 1", "3 values"});
}

}  // namespace
}  // namespace rilo::test
