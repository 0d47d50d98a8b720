// Input that changes while it is read: docs/faults.md.
#include <csignal>

#include <gmock/gmock.h>

#include "cli/drives.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kSpoiled = 60;

// Stops the run after some sweeps, changes one that comes later, and lets it go on.
Outcome run_with_change(const TempDir& folder, const std::function<void(const fs::path&)>& change) {
  const auto out = folder / "out";
  const auto sweeps = long_folder(folder, 100);
  CommandProcess run({"run", sweeps, "--out", out, "--threads", "1", "--quiet"});
  EXPECT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
  run.send(SIGSTOP);
  EXPECT_LT(complete_lines(out / "poses_lidar.partial.txt"), kSpoiled - 10);  // less what is read ahead
  const auto file = sweeps / (std::to_string(kSpoiled) + ".bin");
  fs::remove(file);  // a link to the shared drive
  change(file);
  run.send(SIGCONT);
  return run.wait();
}

void expect_kept_before(const std::function<void(const fs::path&)>& spoil, const std::string& said) {
  const TempDir folder;
  const Outcome outcome = run_with_change(folder, spoil);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  for (const std::string& part : {std::string("60.bin"), said, std::string("kept: 60 sweeps before it")}) {
    EXPECT_THAT(outcome.err, HasSubstr(part));
  }
  EXPECT_EQ(read_kitti_poses(folder / "out" / "poses_lidar.txt").size(), kSpoiled);
  EXPECT_EQ(json_file(folder / "out" / "metrics.json")["frames"], kSpoiled);
}

TEST(Faults, InputIsCutOffMeanwhile) {
  expect_kept_before([](const fs::path& file) { replace(file, std::string(1003, '\x01')); }, "1003 bytes");
}

TEST(Faults, InputDisappearsMeanwhile) {
  expect_kept_before([](const fs::path& /*removed*/) {}, "No such file");
}

TEST(Faults, InputIsReplacedMeanwhile) {
  expect_kept_before([](const fs::path& file) { fs::create_directory(file); }, "folder");
}

// Nobody can tell: the new one is run.
TEST(Faults, InputIsReplacedByAnotherSweepMeanwhile) {
  constexpr std::size_t kPoints = 7000;
  const TempDir folder;
  const Outcome outcome = run_with_change(folder, [](const fs::path& file) {
    replace(file, slurp(sweep_file(shared_drive(), 0)).substr(0, kPoints * 4 * sizeof(float)));
  });
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lines = lines_of(slurp(folder / "out" / "sweeps.csv"));
  ASSERT_EQ(lines.size(), 101U);
  ASSERT_THAT(lines[0], testing::StartsWith("sweep,stamp_ns,status,points_in,"));
  const auto points_in = [&](std::size_t sweep) {
    const std::string& line = lines[sweep + 1];
    std::size_t at = 0;
    for (int column = 0; column < 3; ++column) at = line.find(',', at) + 1;
    return std::stoul(line.substr(at));
  };
  EXPECT_EQ(points_in(kSpoiled), kPoints);
  EXPECT_GT(points_in(kSpoiled - 1), kPoints);
}

TEST(Faults, TheClockOfTheDataJumpsBack) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  std::string times;
  for (std::size_t i = 0; i < kDriveSweeps; ++i) {
    const double jump = i < kDriveSweeps / 2 ? 0 : 3600;
    times += std::to_string(4000 + 0.1 * static_cast<double>(i) - jump) + "\n";
  }
  replace(drive / "times.txt", times);
  const auto out = folder / "out";
  const Outcome run = rilo_succeeds({"run", drive, "--out", out});
  EXPECT_THAT(run.err, HasSubstr("the stamps go back by"));
  const auto metrics = json_file(out / "metrics.json");
  EXPECT_EQ(metrics["frames"], kDriveSweeps);
  EXPECT_EQ(metrics["status"]["lost"], 0);
  // Poses do not depend on what the clock says, only on how it goes on.
  rilo_succeeds({"run", shared_drive(), "--out", folder / "usual", "--quiet"});
  const auto poses = read_kitti_poses(out / "poses_lidar.txt");
  const auto usual = read_kitti_poses(folder / "usual" / "poses_lidar.txt");
  ASSERT_EQ(poses.size(), usual.size());
  EXPECT_LT((poses.back().translation() - usual.back().translation()).norm(), 0.05);
}

}  // namespace
}  // namespace rilo::test
