// The library's two-pass call and `rilo run` give the same bits.
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/command_process.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "rilo/session/session.hpp"
#include "shared_folder.hpp"
#include "simulation/drive_writer.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

// The MCAP file holds poses, velocities and covariances in binary: its bytes are theirs.
void expect_same_run(const fs::path& data, const SessionOptions& options, const SourceOptions& source,
                     const std::vector<std::string>& flags, const TempDir& folder) {
  const fs::path out = folder / "command";
  std::vector<std::string> arguments = {"run", data, "--out", out, "--no-report", "--quiet"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  rilo_succeeds(arguments);

  const SessionResult run = run_recording(data, options, source);
  const auto metrics = nlohmann::json::parse(slurp(out / "metrics.json"));
  ASSERT_TRUE(run.restart) << "the run had one pass only";
  EXPECT_EQ(metrics["started_over_after_sweeps"], run.restart->after_sweeps);
  write_kitti_poses(folder / "library.txt", run.trajectory());
  write_mcap(folder / "library.mcap", run.results);
  EXPECT_EQ(slurp(folder / "library.txt"), slurp(out / "poses_lidar.txt"));
  EXPECT_TRUE(slurp(folder / "library.mcap") == slurp(out / "trajectory.mcap")) << "trajectory.mcap differs";
}

TEST(SameAsCommand, OnASimulatedDrive) {
  const TempDir folder;
  DriveConfig drive;
  drive.sensor = SensorKind::kVlp16;
  drive.sweeps = 30;
  drive.start_s = 10.0;
  write_drive(DriveSimulator(drive), folder / "drive");
  SessionOptions options;
  options.config.elevation.significance = 0;
  expect_same_run(folder / "drive", options, {}, {"--set", "elevation.significance=0"}, folder);
}

TEST(SameAsCommand, OnKittiRaw0001) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP()
      << "four passes over real sweeps take sanitizers a quarter of an hour; the simulated drive runs the same code";
#endif
  const fs::path archive = shared_folder() / "data" / "kitti_raw_0001.tar.xz";
  if (!fs::exists(archive)) GTEST_SKIP() << "no " << archive;
  const TempDir folder;
  const std::string command = "tar -xJf '" + archive.string() + "' -C '" + folder.path().string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  SourceOptions source;
  source.point_times = PointTimes::kAzimuth;
  expect_same_run(folder / "kitti_raw_0001", {}, source, {"--point-times", "azimuth"}, folder);
}

}  // namespace
}  // namespace rilo::test
