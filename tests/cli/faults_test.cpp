// What breaks around a run: docs/faults.md, line by line. Killed and interrupted runs and benchmarks, output that
// cannot be written from the start, input that changes and simulations are in interrupted_run_test, bench_resume_test,
// unwritable_output_test, faults_input_test and simulate_faults_test.
#include <csignal>
#include <cstdlib>
#include <sys/wait.h>

#include <gmock/gmock.h>

#include "cli/drives.hpp"
#include "cli/shortages.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kLongRun = 2000;

// Every result is there as a whole or not at all, and nothing else lies around.
void expect_whole_files(const fs::path& out) {
  if (fs::exists(out / "poses_lidar.txt")) {
    EXPECT_EQ(read_kitti_poses(out / "poses_lidar.txt").size(), kDriveSweeps);
  }
  if (fs::exists(out / "trajectory.tum")) {
    EXPECT_EQ(read_tum(out / "trajectory.tum").size(), kDriveSweeps);
  }
  if (fs::exists(out / "sweeps.csv")) {
    EXPECT_EQ(complete_lines(out / "sweeps.csv"), kDriveSweeps + 1);
  }
  if (fs::exists(out / "metrics.json")) {
    EXPECT_EQ(json_file(out / "metrics.json")["frames"], kDriveSweeps);
  }
  if (fs::exists(out / "map.ply")) {
    EXPECT_GT(read_ply(out / "map.ply").points.size(), 100U);
  }
  for (const auto& entry : fs::directory_iterator(out)) EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST(Faults, KilledWhileResultsAreWritten) {
  for (const char* moment : {"poses_lidar.partial.txt", "poses_lidar.txt", "config.yaml", "metrics.json", "map.ply"}) {
    SCOPED_TRACE(moment);
    const TempDir folder;
    const auto out = folder / "out";
    {
      CommandProcess run({"run", shared_drive(), "--out", out, "--map", out / "map.ply", "--threads", "1", "--quiet"});
      run.wait_until([&] { return fs::exists(out / moment); });
      run.send(SIGKILL);
      run.wait();
    }
    expect_whole_files(out);
    rilo_succeeds({"run", shared_drive(), "--out", out, "--map", out / "map.ply", "--quiet"});
    expect_whole_files(out);
    EXPECT_TRUE(fs::exists(out / "map.ply"));
    EXPECT_FALSE(fs::exists(out / "poses_lidar.partial.txt"));
  }
}

TEST(Faults, InterruptedWhileResultsAreWrittenItStillWritesThem) {
  const TempDir folder;
  const auto out = folder / "out";
  CommandProcess run({"run", shared_drive(), "--out", out, "--map", out / "map.ply", "--threads", "1", "--quiet"});
  ASSERT_TRUE(run.wait_until([&] { return fs::exists(out / "poses_lidar.txt"); }));
  run.send(SIGTERM);
  const Outcome outcome = run.wait();
  if (outcome.signal != 0) {
    GTEST_SKIP() << "all was written before the signal came";
  }
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_whole_files(out);
  EXPECT_TRUE(fs::exists(out / "map.ply"));
}

// A limit on the size of files stops the growing file first, in the middle of a line.
TEST(Faults, ALimitOnTheSizeOfFilesKeepsTheLinesBefore) {
  const TempDir folder;
  const auto out = folder / "out";
  const fs::path& drive = shared_drive();  // made before the limit holds
  {
    const Limit limit(RLIMIT_FSIZE, 2000);
    rilo_fails(4, {"run", drive, "--out", out, "--quiet"}, {"cannot write", "too large"});
  }
  const auto kept = read_kitti_poses(out / "poses_lidar.partial.txt");
  EXPECT_GE(kept.size(), 3U);
  EXPECT_LT(kept.size(), kDriveSweeps);
  expect_whole_files(out);
}

TEST(Faults, AFullDiskKeepsWhatFitsAndABenchmarkGoesOnWhenThereIsRoom) {
  const TempDir folder;
  const auto out = folder / "disk";
  const SmallDisk disk(out, "size=64k");
  if (!disk.mounted()) {
    GTEST_SKIP() << "no disk can be mounted here";
  }
  rilo_fails(4, {"run", shared_drive(), "--out", out, "--quiet"}, {"No space left", "Free some disk space"});
  expect_whole_files(out);
  EXPECT_EQ(read_kitti_poses(out / "poses_lidar.partial.txt").size(), kDriveSweeps);
  for (const auto& entry : fs::directory_iterator(out)) fs::remove_all(entry.path());
  const auto plan =
      folder.write("plan.yaml", "repeats: 12\nsequences: [{path: '" + shared_drive().string() + "', count: 3}]\n");
  const std::vector<std::string> bench = {"bench", plan, "--out", out, "--quiet"};
  EXPECT_EQ(rilo_command(bench).exit_code, 4);
  ASSERT_TRUE(disk.change(0, "size=4m"));
  rilo_succeeds(bench);
  EXPECT_EQ(json_file(out / "results.json")["cells_run"], 12);
}

TEST(Faults, AReadOnlyDiskIsSaidBeforeTheRun) {
  const TempDir folder;
  const SmallDisk disk(folder / "disk", "size=64k");
  if (!disk.mounted() || !disk.change(MS_RDONLY, "size=64k")) {
    GTEST_SKIP() << "no disk can be mounted here";
  }
  rilo_fails(4, {"run", shared_drive(), "--out", folder / "disk", "--quiet"}, {"Read-only file system"});
  rilo_fails(4, {"run", shared_drive(), "--out", folder / "disk" / "new", "--quiet"}, {"Read-only file system"});
  const auto plan = folder.write("plan.yaml", "sequences: [{path: '" + shared_drive().string() + "'}]\n");
  rilo_fails(4, {"bench", plan, "--out", folder / "disk", "--quiet"}, {"Read-only file system"});
  rilo_fails(4, {"simulate", "--out", folder / "disk"}, {"Read-only file system"});
}

TEST(Faults, TheOutputFolderDisappears) {
  const TempDir folder;
  const auto out = folder / "out";
  CommandProcess run({"run", long_folder(folder, 60), "--out", out, "--threads", "1", "--quiet"});
  ASSERT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
  fs::remove_all(out);
  const Outcome outcome = run.wait();
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("does not exist"));
}

TEST(Faults, AMemoryLimitIsSaidAndKeepsTheSweepsBefore) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more memory than any limit allows";
#endif
  std::size_t exhausted = 0;
  for (int mib = 40; mib <= 120; ++mib) {
    SCOPED_TRACE(mib);
    const TempDir folder;
    const auto out = folder / "out";
    // By a shell: this process cannot live within such a limit.
    const std::string command = "ulimit -v " + std::to_string(mib * 1024) + " && exec \"$RILO_BIN\" run '" +
                                shared_drive().string() + "' --out '" + out.string() +
                                "' --threads 1 --quiet >/dev/null 2>'" + (folder / "err").string() + "'";
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 127) continue;  // too little for its libraries
    if (WEXITSTATUS(status) == 0) break;
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_THAT(slurp(folder / "err"), testing::AnyOf(HasSubstr("out of memory"), HasSubstr("pthread_create")));
    ++exhausted;
    if (!fs::exists(out / "metrics.json")) continue;
    EXPECT_EQ(json_file(out / "metrics.json")["frames"], read_kitti_poses(out / "poses_lidar.txt").size());
  }
  EXPECT_GT(exhausted, 0U);
}

TEST(Faults, TwoRunsIntoOneFolder) {
  const TempDir folder;
  const auto out = folder / "out";
  const auto sweeps = long_folder(folder, kLongRun);
  const auto plan = folder.write("plan.yaml", "sequences: [{path: '" + shared_drive().string() + "'}]\n");
  {
    CommandProcess first({"run", sweeps, "--out", out, "--threads", "1", "--quiet"});
    ASSERT_TRUE(first.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
    rilo_fails(4, {"run", shared_drive(), "--out", out}, {"another rilo is writing"});
    rilo_fails(4, {"bench", plan, "--out", out}, {"another rilo is writing"});
    EXPECT_GT(complete_lines(out / "poses_lidar.partial.txt"), 0U);
    first.send(SIGINT);
    EXPECT_EQ(first.wait().exit_code, 130);
  }
  // Whoever is killed leaves no lock behind.
  CommandProcess killed({"run", sweeps, "--out", out, "--threads", "1", "--quiet"});
  ASSERT_TRUE(killed.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
  killed.send(SIGKILL);
  killed.wait();
  rilo_succeeds({"run", shared_drive(), "--out", out, "--quiet"});
}

}  // namespace
}  // namespace rilo::test
