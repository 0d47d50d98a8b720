// Ground truth of KITTI raw drives as downloaded.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "io/folders/ground_truth.hpp"
#include "io/io_test_util.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "shared_folder.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

constexpr double kEarthRadiusM = 6378137;
constexpr double kLatitudeDeg = 49.015;
constexpr double kDeg = std::numbers::pi / 180;

// Of 2011_09_26, with the digits of KITTI's file.
constexpr const char* kCalibration =
    "calib_time: 25-May-2012 16:47:16\n"
    "R: 9.999976e-01 7.553071e-04 -2.035826e-03 -7.854027e-04 9.998898e-01 -1.482298e-02 2.024406e-03 1.482454e-02 "
    "9.998881e-01\n"
    "T: -8.086759e-01 3.195559e-01 -7.997231e-01\n";

SE3 velo_from_imu() {
  SE3 T = SE3::Identity();
  T.linear() << 9.999976e-01, 7.553071e-04, -2.035826e-03, -7.854027e-04, 9.998898e-01, -1.482298e-02, 2.024406e-03,
      1.482454e-02, 9.998881e-01;
  T.translation() << -8.086759e-01, 3.195559e-01, -7.997231e-01;
  return T;
}

// A car in a curve on a hill; roll, pitch and yaw in rad, position in m east, north, up.
struct CarPose {
  Eigen::Vector3d position;
  double roll = 0;
  double pitch = 0;
  double yaw = 0;

  SE3 world_from_imu() const {
    SE3 T = SE3::Identity();
    T.linear() = so3_exp({0, 0, yaw}) * so3_exp({0, pitch, 0}) * so3_exp({roll, 0, 0});
    T.translation() = position;
    return T;
  }
};
CarPose car_pose(int i) {
  const double s = 1.4 * i;
  return {{600'000 + 40 * std::sin(s / 40), 4'000'000 + 40 * std::cos(s / 40), 116 + 0.05 * s},
          0.03 * std::sin(0.2 * i),
          -0.02 + 0.01 * std::cos(0.3 * i),
          -2.6 - s / 40};
}

// The inverse of the projection: with the first latitude's scale, east and north become degrees.
std::string oxts_line(const CarPose& pose, const CarPose& first) {
  const double scale = std::cos(kLatitudeDeg * kDeg);
  const double north_of_equator = scale * kEarthRadiusM * std::log(std::tan((90 + kLatitudeDeg) * kDeg / 2));
  const double north = north_of_equator + pose.position.y() - first.position.y();
  const double latitude = 2 * std::atan(std::exp(north / (scale * kEarthRadiusM))) / kDeg - 90;
  const double longitude = pose.position.x() / (scale * kEarthRadiusM) / kDeg;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%.17g %.17g %.17g %.17g %.17g %.17g 1.5 -2 3 4 5 6 7 8 9 0 1 2 3 4 5 6 7 8 9 4 10 4 4 0\n", latitude,
                longitude, pose.position.z(), pose.roll, pose.pitch, pose.yaw);
  return text.data();
}

std::string number_of(int i) { return std::string(10 - std::to_string(i).size(), '0') + std::to_string(i); }

// A drive of 30 sweeps, of which the fifth is missing.
constexpr int kOxtsSweeps = 30;
constexpr int kMissing = 5;
fs::path write_drive(const TempDir& folder, bool calibrated = true) {
  const std::string drive = "2011_09_26/2011_09_26_drive_0001_sync";
  std::string dates;
  for (int i = 0; i < kOxtsSweeps; ++i) {
    if (i != kMissing) folder.write(drive + "/velodyne_points/data/" + number_of(i) + ".bin", bin_of(1));
    folder.write(drive + "/oxts/data/" + number_of(i) + ".txt", oxts_line(car_pose(i), car_pose(0)));
    const std::string tenths = std::to_string(100 + i);
    dates += "2011-09-26 13:02:" + tenths.substr(1) + ".000000000\n";
  }
  folder.write(drive + "/velodyne_points/timestamps.txt", dates);
  folder.write(drive + "/oxts/timestamps.txt", dates);
  if (calibrated) folder.write("2011_09_26/calib_imu_to_velo.txt", kCalibration);
  return folder / drive;
}

TEST(KittiOxtsTest, TheTrajectoryOfTheLidar) {
  const TempDir folder;
  const fs::path drive = write_drive(folder);
  const auto truth = read_ground_truth(drive, PoseInstant::kMid);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->instant, "stamp");
  EXPECT_TRUE(truth->warnings.empty());
  ASSERT_EQ(truth->T_world_lidar.size(), kOxtsSweeps - 1U);
  EXPECT_TRUE(truth->T_world_lidar[0].isApprox(SE3::Identity(), 1e-15));
  const SE3 T_imu_velo = velo_from_imu().inverse(Eigen::Affine);
  const SE3 first = (car_pose(0).world_from_imu() * T_imu_velo).inverse();
  for (std::size_t k = 0; k < truth->T_world_lidar.size(); ++k) {
    const int i = static_cast<int>(k) + (k >= kMissing ? 1 : 0);
    const SE3 expected = first * car_pose(i).world_from_imu() * T_imu_velo;
    // Degrees with 17 digits are good to some nm; the calibration's rotation is one to 1e-6.
    EXPECT_LT((truth->T_world_lidar[k].translation() - expected.translation()).norm(), 1e-5) << i;
    EXPECT_LT((truth->T_world_lidar[k].linear() - expected.linear()).cwiseAbs().maxCoeff(), 3e-6) << i;
  }
  EXPECT_EQ(read_ground_truth(drive, PoseInstant::kEnd)->warnings.size(), 1U);  // at the stamps, not at the end
}

TEST(KittiOxtsTest, OtherTruthGoesBefore) {
  const TempDir folder;
  const fs::path drive = write_drive(folder);
  std::string rows;
  for (int i = 1; i < kOxtsSweeps; ++i) rows += kitti_row(i, 0, 0);
  folder.write(fs::relative(drive / "poses_velo.txt", folder.path()).string(), rows);
  EXPECT_EQ(read_ground_truth(drive, PoseInstant::kMid)->file.filename(), "poses_velo.txt");
}

TEST(KittiOxtsTest, TheCalibration) {
  const TempDir folder;
  const fs::path drive = write_drive(folder, false);
  const auto read = [&] { read_ground_truth(drive, PoseInstant::kMid); };
  expect_io_error(read, {"oxts", "no calib_imu_to_velo.txt", "2011_09_26", "unpack it beside the drive"});
  for (const char* text : {"R: 1 0 0\nT: 0 0 0\n", "T: 0 0 0\n", "R: 1 0 0 0 1 0 0 0 1\n",
                           "R: 2 0 0 0 1 0 0 0 1\nT: 0 0 0\n", "R: 1 0 0 0 1 0 0 0 -1\nT: 0 0 0\n"}) {
    folder.write("2011_09_26/calib_imu_to_velo.txt", text);
    expect_io_error(read, {"calib_imu_to_velo.txt", "R: with the 9 numbers of a rotation"});
  }
  std::ofstream(drive / "calib_imu_to_velo.txt") << kCalibration;  // in the drive itself, before that of the day
  EXPECT_EQ(read_ground_truth(drive, PoseInstant::kMid)->T_world_lidar.size(), kOxtsSweeps - 1U);
}

TEST(KittiOxtsTest, DamagedDrives) {
  const TempDir folder;
  const fs::path drive = write_drive(folder);
  const fs::path file = drive / "oxts/data" / (number_of(3) + ".txt");
  const auto read = [&] { read_ground_truth(drive, PoseInstant::kMid); };
  const auto refused = [&](const std::string& text, std::initializer_list<std::string_view> parts) {
    std::ofstream(file) << text;
    expect_io_error(read, parts);
  };
  refused("49 8 116 0 0\n", {"0000000003.txt, line 1", "the end of the line", "pitch and yaw"});
  refused("", {"0000000003.txt", "line 1"});
  refused("49 8 up 0 0 0\n", {"0000000003.txt, line 1, column 6", "'up'"});
  refused("49 8 nan 0 0 0\n", {"0000000003.txt, line 1, column 6", "'nan'"});
  refused("90 8 116 0 0 0\n", {"0000000003.txt, line 1", "latitude 90"});
  fs::remove(file);
  expect_io_error(read, {"oxts/data: 29 files", "30 sweeps", "_sync"});
  std::ofstream(drive / "oxts/data/other.txt") << "the count is right again";
  expect_io_error(read, {"0000000003.txt"});
}

// A real drive: what others computed from the same numbers.
TEST(KittiOxtsTest, RealDriveAsComputedElsewhere) {
  const fs::path archive = shared_folder() / "data/kitti_raw_0001.tar.xz";
  if (!fs::exists(archive)) {
    GTEST_SKIP() << "no ../shared/data/kitti_raw_0001.tar.xz";
  }
  const TempDir folder;
  const std::string command = "tar -xJf '" + archive.string() + "' -C '" + folder.path().string() +
                              "' kitti_raw_0001/oxts_poses.txt kitti_raw_0001/poses_velo.txt";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream lines(folder / "kitti_raw_0001/oxts_poses.txt");
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    // index, stamp, latitude, longitude, altitude, three that were derived, roll, pitch, yaw
    std::array<std::string, 11> words;
    std::istringstream text(line);
    for (std::string& word : words) text >> word;
    if (words[0] == "#") continue;
    folder.write("d/oxts/data/" + number_of(count) + ".txt",
                 words[2] + " " + words[3] + " " + words[4] + " " + words[8] + " " + words[9] + " " + words[10] + "\n");
    folder.write("d/velodyne_points/data/" + number_of(count) + ".bin", bin_of(1));
    ++count;
  }
  folder.write("d/calib_imu_to_velo.txt", kCalibration);
  const auto truth = read_ground_truth(folder / "d", PoseInstant::kMid);
  const auto expected = read_kitti_poses(folder / "kitti_raw_0001/poses_velo.txt");
  ASSERT_EQ(truth->T_world_lidar.size(), expected.size());
  ASSERT_EQ(expected.size(), 108U);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((truth->T_world_lidar[i].translation() - expected[i].translation()).norm(), 1e-4) << i;
    EXPECT_LT((truth->T_world_lidar[i].linear() - expected[i].linear()).cwiseAbs().maxCoeff(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace rilo::test
