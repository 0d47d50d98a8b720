#include <limits>
#include <random>
#include <string>

#include "io/io_test_util.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

constexpr std::int64_t kMostStamp = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kLeastStamp = std::numeric_limits<std::int64_t>::min();

Trajectory some_trajectory() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Trajectory trajectory;
  for (int i = 0; i < 50; ++i) {
    Vector6d twist;
    for (Eigen::Index k = 0; k < 6; ++k) twist[k] = 2.5 * uniform(random);
    twist.tail<3>() *= 1000;
    trajectory.push_back({1'317'042'145'964'000'001 + i * 103'600'123LL, se3_exp(twist)});
  }
  return trajectory;
}

TEST(PoseWriterTest, EurocHasNanosecondsAndTheScalarFirst) {
  const TempDir folder;
  SE3 T = SE3::Identity();
  T.translation() = Eigen::Vector3d(1, -2, 0.5);
  write_euroc(folder.path() / "t.csv", {{1'700'000'000'000'000'001, T}});
  EXPECT_EQ(slurp(folder.path() / "t.csv"),
            "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n"
            "1700000000000000001,1.000000000,-2.000000000,0.500000000,1.000000000000,0.000000000000,0.000000000000,"
            "0.000000000000\n");
}

TEST(StampTest, FormatIsExact) {
  EXPECT_EQ(format_stamp(0), "0.000000000");
  EXPECT_EQ(format_stamp(1'500'000'000), "1.500000000");
  EXPECT_EQ(format_stamp(-1), "-0.000000001");
  EXPECT_EQ(format_stamp(-2'500'000'000), "-2.500000000");
  EXPECT_EQ(format_stamp(kMostStamp), "9223372036.854775807");
  EXPECT_EQ(format_stamp(kLeastStamp), "-9223372036.854775808");
}

TEST(StampTest, ParseIsExact) {
  EXPECT_EQ(parse_stamp("1317042145.964000001"), 1'317'042'145'964'000'001);
  EXPECT_EQ(parse_stamp("1.100000e-01"), 110'000'000);
  EXPECT_EQ(parse_stamp("1.6e9"), 1'600'000'000'000'000'000);
  EXPECT_EQ(parse_stamp("-.5"), -500'000'000);
  EXPECT_EQ(parse_stamp("+2."), 2'000'000'000);
  EXPECT_EQ(parse_stamp("0.0000000014"), 1);
  EXPECT_EQ(parse_stamp("0.0000000015"), 2);
  EXPECT_EQ(parse_stamp("-0.0000000015"), -2);
  EXPECT_EQ(parse_stamp("5e-10"), 1);
  EXPECT_EQ(parse_stamp("4e-10"), 0);
  EXPECT_EQ(parse_stamp("9e-20"), 0);
  EXPECT_EQ(parse_stamp("00000000000000000000000001"), 1'000'000'000);
  EXPECT_EQ(parse_stamp("9223372036.854775807"), kMostStamp);
}

TEST(StampTest, RefusesWhatIsNoStamp) {
  for (const char* text : {"", "-", ".", "1.2.3", "1e", "e5", "nan", "inf", "1 2", "0x10", "9223372036.854775808",
                           "1e400", "1e999999999999", "1e-9223372036854775808", "12a", "--1", "1e5e5"}) {
    EXPECT_FALSE(parse_stamp(text)) << text;
  }
}

TEST(StampTest, RoundTripOfRandomStamps) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto stamp = static_cast<std::int64_t>(random() >> (i % 60 + 1)) * (i % 2 == 0 ? 1 : -1);
    EXPECT_EQ(parse_stamp(format_stamp(stamp)), stamp);
  }
}

void expect_near(const std::vector<SE3>& poses, const Trajectory& trajectory, double tolerance) {
  ASSERT_EQ(poses.size(), trajectory.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((poses[i].matrix() - trajectory[i].T_odom_lidar.matrix()).cwiseAbs().maxCoeff(), tolerance);
  }
}

TEST(PoseFileTest, KittiRoundTrip) {
  const TempDir folder;
  const Trajectory trajectory = some_trajectory();
  write_kitti_poses(folder / "p.txt", trajectory);
  expect_near(read_kitti_poses(folder / "p.txt"), trajectory, 1e-9);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(PoseFileTest, TumRoundTripKeepsStampsExactly) {
  const TempDir folder;
  const Trajectory trajectory = some_trajectory();
  write_tum(folder / "p.tum", trajectory);
  const Trajectory read = read_tum(folder / "p.tum");
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_ns, trajectory[i].stamp_ns);
    EXPECT_LT((read[i].T_odom_lidar.matrix() - trajectory[i].T_odom_lidar.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(PoseFileTest, EurocRoundTripKeepsStampsExactly) {
  const TempDir folder;
  const Trajectory trajectory = some_trajectory();
  write_euroc(folder / "p.csv", trajectory);
  const Trajectory read = read_euroc(folder / "p.csv");
  ASSERT_EQ(read.size(), trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_ns, trajectory[i].stamp_ns);
    EXPECT_LT((read[i].T_odom_lidar.matrix() - trajectory[i].T_odom_lidar.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// EuRoC's ground truth has velocities and biases behind the pose.
TEST(PoseFileTest, OfEurocThePoseAloneIsTaken) {
  const TempDir folder;
  const auto file =
      folder.write("data.csv", "#timestamp [ns], p, q, v\n1403636580838555648, 4,-1 ,0.5,0,0,0,1, 7,8,9\n");
  const Trajectory read = read_euroc(file);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].stamp_ns, 1403636580838555648);
  EXPECT_EQ(read[0].T_odom_lidar.translation(), Eigen::Vector3d(4, -1, 0.5));
  EXPECT_TRUE((read[0].T_odom_lidar.linear() * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitX()));
  const auto fails = [&](const std::string& line, std::initializer_list<std::string_view> parts) {
    const auto bad = folder.write("bad.csv", "1,0,0,0,1,0,0,0\n" + line);
    expect_io_error([&] { read_euroc(bad); }, parts);
  };
  fails("1,0,0,0,1,0,0\n", {"line 2", "7 values", "8 numbers"});
  fails("1.5,0,0,0,1,0,0,0\n", {"line 2, column 1", "'1.5'", "whole number of ns"});
  fails("99999999999999999999,0,0,0,1,0,0,0\n", {"line 2, column 1"});
  fails("1,0,x,0,1,0,0,0\n", {"line 2, column 5", "'x'"});
  fails("1,0,0,0,1,1,0,0\n", {"line 2", "norm"});
}

TEST(PoseFileTest, TumOfAKnownPose) {
  const TempDir folder;
  StampedPose pose;
  pose.stamp_ns = -1;
  pose.T_odom_lidar.translation() << 1, -2.5, 1e-9;
  pose.T_odom_lidar.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  write_tum(folder / "p.tum", {pose});
  EXPECT_EQ(slurp(folder / "p.tum"),
            "-0.000000001 1.000000000 -2.500000000 0.000000001 0.000000000000 0.000000000000 0.707106781187 "
            "0.707106781187\n");
}

TEST(PoseFileTest, CameraFrameThereAndBack) {
  const TempDir folder;
  const Trajectory trajectory = some_trajectory();
  Vector6d twist;
  twist << 1.2, -1.2, 1.2, -0.01, -0.05, -0.29;
  const SE3 T_cam_lidar = se3_exp(twist);
  write_kitti_poses_camera(folder / "c.txt", trajectory, T_cam_lidar);
  expect_near(camera_to_lidar(read_kitti_poses(folder / "c.txt"), T_cam_lidar), trajectory, 1e-8);
}

TEST(PoseFileTest, CommentsBlankLinesAndCarriageReturns) {
  const TempDir folder;
  const auto file = folder.write("p.txt", "# a comment\r\n\r\n1 0 0 5 0 1 0 6 0 0 1 7\r\n\t\r\n");
  const auto poses = read_kitti_poses(file);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_TRUE(read_kitti_poses(folder.write("empty.txt", "")).empty());
  // As editors on Windows begin a file.
  EXPECT_EQ(read_tum(folder.write("bom.tum",
                                  "\xEF\xBB\xBF"
                                  "1 2 3 4 0 0 0 1\n"))
                .size(),
            1U);
}

TEST(PoseFileTest, KittiErrorsHaveLineAndColumn) {
  const TempDir folder;
  const std::string good = "1 0 0 5 0 1 0 6 0 0 1 7\n";
  const auto fails = [&](const std::string& line, std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("p.txt", good + line);
    expect_io_error([&] { read_kitti_poses(file); }, parts);
  };
  fails("1 0 0 5 0 1 0 6 0 0 1\n", {"p.txt", "line 2", "11 values", "12 numbers"});
  fails("1 0 0 5 0 1 0 6 0 0 1 7 8\n", {"line 2", "13 values"});
  fails("1 0 0 five 0 1 0 6 0 0 1 7\n", {"line 2, column 7", "'five'"});
  fails("1 0 0 nan 0 1 0 6 0 0 1 7\n", {"line 2, column 7", "finite"});
  fails("1 0 0 1e999 0 1 0 6 0 0 1 7\n", {"line 2, column 7"});
  fails("2 0 0 5 0 1 0 6 0 0 1 7\n", {"line 2", "not a rotation", "rigid"});
  fails("0 0 0 5 0 0 0 6 0 0 0 7\n", {"line 2", "not a rotation"});
  fails("-1 0 0 5 0 1 0 6 0 0 1 7\n", {"line 2", "reflection"});
  fails("1 0 0 5 0 1 0 6 0 0 1 7e9\n", {"line 2", "a position", "below 1e9"});
  expect_io_error([&] { read_kitti_poses(folder / "none.txt"); }, {"none.txt", "No such file"});
  expect_io_error([&] { read_kitti_poses(folder.path()); }, {"it is a folder"});
}

TEST(PoseFileTest, OfAFileThatGrowsOnlyWholeLines) {
  const TempDir folder;
  const auto file = folder.write("k.txt", "1 0 0 5 0 1 0 0 0 0 1 0\n1 0 0 6 0 1 0 0 0 0 1 1");  // 10 or 12 is to come
  EXPECT_EQ(read_growing_kitti_poses(file).size(), 1U);
  EXPECT_EQ(read_kitti_poses(file).size(), 2U);
  EXPECT_TRUE(read_growing_kitti_poses(folder.write("first.txt", "1 0 0")).empty());
}

TEST(PoseFileTest, TheTransformIsTheLineThatBeginsWithItsName) {
  const TempDir folder;
  const auto file = folder.write("calib.txt", "of_Tr: none\nTr: 1 0 0 0.5 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(read_kitti_calibration(file).value().translation().x(), 0.5);
}

// RᵀR may be off by a thousandth, and so may a quaternion's length, which is made good.
TEST(PoseFileTest, RotationsAreSuchToThreeDigits) {
  const TempDir folder;
  const auto kitti = [&](const std::string& scale) {
    return read_kitti_poses(folder.write("k.txt", scale + " 0 0 1 0 1 0 2 0 0 1 3\n"));
  };
  EXPECT_EQ(kitti("1.0004").size(), 1U);
  expect_io_error([&] { kitti("1.0006"); }, {"k.txt, line 1", "not a rotation"});
  const auto tum = [&](const std::string& z, const std::string& w) -> Eigen::Matrix3d {
    return read_tum(folder.write("t.txt", "5 1 2 3 0 0 " + z + " " + w + "\n")).at(0).T_odom_lidar.linear();
  };
  const Eigen::Matrix3d R = tum("0.6005", "0.8006");
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
  expect_io_error([&] { tum("0.59", "0.8"); }, {"t.txt, line 1", "norm 1"});
  expect_io_error([&] { tum("0.61", "0.8"); }, {"t.txt, line 1", "norm 1"});
}

TEST(PoseFileTest, TumErrorsHaveLineAndColumn) {
  const TempDir folder;
  const auto fails = [&](const std::string& line, std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("p.tum", "# t x y z qx qy qz qw\n" + line);
    expect_io_error([&] { read_tum(file); }, parts);
  };
  fails("1 0 0 0 0 0 0\n", {"line 2", "7 values", "8 numbers"});
  fails("1s 0 0 0 0 0 0 1\n", {"line 2, column 1", "'1s'"});
  fails("1 0 0 0 0 0 0 2\n", {"line 2", "norm"});
  fails("1 0 0 0 0 0 0 0\n", {"line 2", "norm"});
  fails("1 0 inf 0 0 0 0 1\n", {"line 2, column 5"});
  fails("1e300 0 0 0 0 0 0 1\n", {"line 2, column 1"});
}

TEST(PoseFileTest, Calibration) {
  const TempDir folder;
  const auto file = folder.write("calib.txt", "P0: 1 2 3\nTr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n");
  const auto T_cam_lidar = read_kitti_calibration(file);
  ASSERT_TRUE(T_cam_lidar);
  // LiDAR forward is camera z, LiDAR left is camera -x.
  EXPECT_TRUE((*T_cam_lidar * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0.1, 0.2, 1.3)));
  EXPECT_TRUE((*T_cam_lidar * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(-0.9, 0.2, 0.3)));
  EXPECT_FALSE(read_kitti_calibration(folder.write("none.txt", "P0: 1 2 3\n")));
  expect_io_error([&] { read_kitti_calibration(folder.write("bad.txt", "P0: 1\nTr: 0 -1 0\n")); },
                  {"bad.txt", "line 2", "3 values"});
  expect_io_error([&] { read_kitti_calibration(folder.write("bad.txt", "Tr: 0 1 0 0 0 0 0 0 0 0 0 0\n")); },
                  {"line 1", "not a rotation"});
}

TEST(PoseFileTest, Stamps) {
  const TempDir folder;
  write_stamps(folder / "times.txt", {0, 103'600'000, 1'317'042'145'964'000'001});
  EXPECT_EQ(read_stamps(folder / "times.txt"), (std::vector<std::int64_t>{0, 103'600'000, 1'317'042'145'964'000'001}));
  expect_io_error([&] { read_stamps(folder.write("t.txt", "0.0\n0.1\nsoon\n")); }, {"t.txt", "line 3", "'soon'"});
  expect_io_error([&] { read_stamps(folder.write("t.txt", "0.0 0.1\n")); }, {"line 1", "expected a date, seconds"});
  EXPECT_EQ(read_stamps(folder.write("t.txt", "# ns\n1317042145964000001\n\n1317042146064000001\n")),
            (std::vector<std::int64_t>{1'317'042'145'964'000'001, 1'317'042'146'064'000'001}));
  EXPECT_EQ(read_stamps(folder.write("t.txt", "2011-09-26 13:02:25.951199337\n")),
            (std::vector<std::int64_t>{1'317'042'145'951'199'337}));
}

}  // namespace
}  // namespace rilo::test
