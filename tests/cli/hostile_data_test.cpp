// Data that are malformed, missing or useless.
#include <limits>
#include <tuple>

#include "cli/drives.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST(HostileData, TrailingBytes) {
  const TempDir folder;
  for (std::size_t bytes = 1; bytes <= 15; ++bytes) {
    const auto file = folder / (std::to_string(bytes) + ".bin");
    fs::copy_file(sweep_file(shared_drive(), 0), file);
    append(file, bytes);
    rilo_fails(3, {"run", file}, {file, "byte"});
  }
}

TEST(HostileData, HeadersThatLie) {
  const TempDir folder;
  const std::string pcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  const std::vector<std::string> files = {
      folder.write("many.pcd", pcd + "WIDTH 4000000000\nHEIGHT 4000000000\nPOINTS 100\nDATA binary\n12345678"),
      folder.write("big.pcd", pcd + "WIDTH 900000000\nHEIGHT 1\nPOINTS 900000000\nDATA binary\n12345678"),
      folder.write("packed.pcd",
                   pcd + "WIDTH 9\nHEIGHT 1\nPOINTS 9\nDATA binary_compressed\n\xff\xff\xff\x7f\xff\xff\xff\x7f"),
      folder.write("negative.pcd", pcd + "WIDTH -1\nHEIGHT 1\nPOINTS -1\nDATA ascii\n1 2 3\n"),
      folder.write("huge.ply",
                   "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\n0123456789ab"),
      folder.write("ascii.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n1 2 3\n"),
  };
  for (const std::string& file : files) {
    const Outcome outcome = rilo_fails(3, {"run", file}, {file});
    EXPECT_EQ(outcome.err.find("out of memory"), std::string::npos) << outcome.err;
  }
}

TEST(HostileData, MissingAndEmptyFolders) {
  const TempDir folder;
  rilo_fails(3, {"run", folder / "nowhere"}, {"nowhere"});
  rilo_fails(3, {"run", folder.path()}, {folder.path()});
  fs::create_directories(folder / "sequence" / "velodyne");
  rilo_fails(3, {"run", folder / "sequence"}, {"sequence"});
  folder.write("notes.txt", "no sweeps here");
  rilo_fails(3, {"run", folder / "notes.txt"}, {"notes.txt"});
}

TEST(HostileData, SweepsOfMixedSizesRun) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  fs::remove_all(drive / "times_pt");
  fs::resize_file(sweep_file(drive, 3), 16 * 9000);
  fs::resize_file(sweep_file(drive, 5), 16 * 7);
  fs::resize_file(sweep_file(drive, 7), 0);
  const auto metrics = json::parse(rilo_succeeds({"run", drive, "--json"}).out);
  EXPECT_EQ(metrics["frames"], kDriveSweeps);
  EXPECT_GE(metrics["status"]["empty"], 1);
}

// Nothing but guesses is no success; the results are kept all the same.
TEST(HostileData, SweepsWithoutAUsablePointSayWhy) {
  const TempDir folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"mm", bytes_of<float>({9000, 0, 0, 0, 0, 9000, 0, 0}), "median range 9000.000 m"},
      {"nan", bytes_of<float>({nan, nan, nan, 0}), "no finite points"},
      {"none", "", "no points"}};
  for (const auto& [name, bytes, why] : cases) {
    for (int i = 0; i < 3; ++i) folder.write(name + "/" + std::to_string(i) + ".bin", bytes);
    rilo_fails(3, {"run", folder / name, "--out", folder / "out", "--quiet"},
               {"3 of 3 sweeps without a usable point", why, "kept: 3 sweeps"});
    const json metrics = json_file(folder / "out" / "metrics.json");
    EXPECT_EQ(metrics["status"]["empty"], 3);
    EXPECT_NE(metrics["error"].get<std::string>().find(why), std::string::npos);
  }
  const auto drive = copy_of_drive(folder);
  fs::remove_all(drive / "times_pt");
  for (std::size_t i = 5; i < kDriveSweeps; ++i) fs::resize_file(sweep_file(drive, i), 0);
  expect_parts(rilo_succeeds({"run", drive}).err, {"warning: 7 of 12 sweeps without a usable point", "no points"});
}

TEST(HostileData, PointTimesOfAnotherSize) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  append(drive / "times_pt" / "000004.bin", 8);
  rilo_fails(3, {"run", drive}, {"000004.bin", "4 sweeps before it"});
}

TEST(HostileData, ASweepOfNanInTheMiddle) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string bytes;
  for (std::size_t i = fs::file_size(sweep_file(drive, 6)) / 16; i > 0; --i)
    bytes += bytes_of<float>({nan, nan, nan, 0});
  replace(sweep_file(drive, 6), bytes);
  rilo_succeeds({"run", drive, "--out", folder / "out", "--quiet"});
  const json metrics = json_file(folder / "out" / "metrics.json");
  EXPECT_EQ(metrics["frames"], kDriveSweeps);
  EXPECT_EQ(metrics["status"]["empty"], 1);
  EXPECT_LT(metrics["evaluation"]["ape_unaligned_m"]["rmse"], 0.5) << "the sweep's gap is bridged";
  const auto poses = read_kitti_poses(folder / "out" / "poses_lidar.txt");  // refuses what is not finite
  EXPECT_EQ(poses.size(), kDriveSweeps);
}

TEST(HostileData, AReadErrorKeepsTheSweepsBefore) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  append(sweep_file(drive, 5), 7);
  rilo_fails(3, {"run", drive, "--out", folder / "out", "--map", folder / "map.pcd"},
             {"000005.bin", "5 sweeps before it"});
  const json metrics = json_file(folder / "out" / "metrics.json");
  EXPECT_EQ(metrics["frames"], 5);
  EXPECT_NE(metrics["error"].get<std::string>().find("000005.bin"), std::string::npos);
  EXPECT_EQ(metrics["interrupted"], false);
  EXPECT_EQ(metrics["evaluation"]["poses"], 5);
  EXPECT_EQ(read_kitti_poses(folder / "out" / "poses_lidar.txt").size(), 5U);
  EXPECT_EQ(read_tum(folder / "out" / "trajectory.tum").size(), 5U);
  EXPECT_EQ(lines_of(slurp(folder / "out" / "sweeps.csv")).size(), 6U);
  EXPECT_GT(read_pcd(folder / "map.pcd").points.size(), 100U);
  EXPECT_NE(slurp(folder / "out" / "report.html").find("000005.bin"), std::string::npos) << "the report says so";
  EXPECT_FALSE(fs::exists(folder / "out" / "poses_lidar.partial.txt"));
}

TEST(HostileData, BadSweepsCanBeSkippedAndAreCounted) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  append(sweep_file(drive, 2), 1);
  append(sweep_file(drive, 9), 15);
  const Outcome run = rilo_succeeds({"run", drive, "--skip-bad-sweeps", "--out", folder / "out"});
  EXPECT_NE(run.err.find("000002.bin"), std::string::npos) << run.err;
  const json metrics = json_file(folder / "out" / "metrics.json");
  EXPECT_EQ(metrics["bad_sweeps"], 2);
  EXPECT_EQ(metrics["frames"], kDriveSweeps - 2);
  EXPECT_EQ(metrics["evaluation"]["poses"], kDriveSweeps - 2);
  EXPECT_LT(metrics["evaluation"]["ape_unaligned_m"]["rmse"], 0.25) << "sweeps matched to the truth of others";
  for (std::size_t i = 0; i < kDriveSweeps; ++i) append(sweep_file(drive, i), i == 2 || i == 9 ? 0 : 2);
  rilo_fails(3, {"run", drive, "--skip-bad-sweeps"}, {"no sweep"});
}

TEST(HostileData, AWrongPoseFileDoesNotSpoilTheRun) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  for (const std::string wrong :
       {"no poses\n", "1 2 3\n", "1 0 0 nan 0 1 0 0 0 0 1 0\n", "9 0 0 0 0 9 0 0 0 0 9 0\n", ""}) {
    replace(drive / "poses_mid.txt", wrong);
    const Outcome run = rilo_succeeds({"run", drive, "--out", folder / "out", "--count", "3", "--no-report"});
    EXPECT_NE(run.err.find("warning"), std::string::npos) << wrong << run.err;
    EXPECT_NE(run.err.find("poses_mid.txt"), std::string::npos) << wrong << run.err;
    const json metrics = json_file(folder / "out" / "metrics.json");
    EXPECT_EQ(metrics["frames"], 3);
    EXPECT_FALSE(metrics.contains("evaluation")) << wrong;
    EXPECT_NE(metrics["warnings"], json::array()) << wrong;
    rilo_fails(3, {"eval", drive, folder / "out" / "poses_lidar.txt"}, {"poses_mid.txt"});
  }
}

}  // namespace
}  // namespace rilo::test
