// What breaks around rilo simulate: docs/faults.md.
#include <csignal>

#include "cli/drives.hpp"
#include "cli/shortages.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

// Gives the bytes of the shared drive.
std::vector<std::string> same_drive_into(const fs::path& out) {
  return {
      "simulate",  "--out", out,      "--sensor", "vlp16", "--start", "10", "--sweeps", std::to_string(kDriveSweeps),
      "--threads", "1",     "--quiet"};
}

std::size_t files_below(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.is_regular_file() ? 1 : 0;
  return count;
}

const char* const kUnfinished = "meta.partial.json";

// No half files, but for one that has not got its name yet.
void expect_files_of_the_drive(const fs::path& out) {
  std::size_t unfinished = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (!entry.is_regular_file() || entry.path().filename() == kUnfinished) continue;
    if (entry.path().extension() == ".tmp") {
      ++unfinished;
    } else {
      const bool same = slurp(entry.path()) == slurp(shared_drive() / entry.path().lexically_relative(out));
      EXPECT_TRUE(same) << entry.path();
    }
  }
  EXPECT_LE(unfinished, 1U);
}

void expect_whole_drive(const fs::path& out) {
  expect_files_of_the_drive(out);
  EXPECT_EQ(files_below(out), files_below(shared_drive()));
}

TEST(SimulateFaults, KilledItLeavesWholeFilesAndStartsAnew) {
  const TempDir folder;
  const auto out = folder / "drive";
  std::size_t killed = 0;
  for (const char* moment : {"velodyne/000000.bin", "times_pt/000001.bin", "velodyne/000005.bin", "times.txt"}) {
    SCOPED_TRACE(moment);
    CommandProcess simulate(same_drive_into(out));
    ASSERT_TRUE(simulate.wait_until([&] { return fs::exists(out / moment); }));
    simulate.send(SIGKILL);
    if (simulate.wait().signal == SIGKILL) ++killed;
    expect_files_of_the_drive(out);
    EXPECT_TRUE(fs::exists(out / "meta.json") || fs::exists(out / kUnfinished));
    rilo_succeeds(same_drive_into(out));
    expect_whole_drive(out);
    fs::remove_all(out);
  }
  EXPECT_GT(killed, 0U);
}

TEST(SimulateFaults, ALimitOnTheSizeOfFilesLeavesNoHalfOnes) {
  const TempDir folder;
  const auto out = folder / "drive";
  ASSERT_GT(fs::file_size(sweep_file(shared_drive(), 0)), 100'000U);
  {
    const Limit limit(RLIMIT_FSIZE, 100'000);
    rilo_fails(4, same_drive_into(out), {"000000.bin", "cannot write", "File too large"});
  }
  EXPECT_EQ(files_below(out), 1U) << "more than " << kUnfinished;
}

TEST(SimulateFaults, AFullDiskKeepsTheSweepsThatFit) {
  const TempDir folder;
  const auto out = folder / "disk";
  const SmallDisk disk(out, "size=2m");
  if (!disk.mounted()) {
    GTEST_SKIP() << "no disk can be mounted here";
  }
  rilo_fails(4, same_drive_into(out), {".bin", "cannot write", "No space left"});
  EXPECT_GT(files_in(out / "velodyne"), 0U);
  expect_files_of_the_drive(out);
  EXPECT_FALSE(fs::exists(out / "meta.json"));
  ASSERT_TRUE(disk.change(0, "size=64m"));
  rilo_succeeds(same_drive_into(out));
  expect_whole_drive(out);
}

TEST(SimulateFaults, TwoIntoOneFolder) {
  const TempDir folder;
  const auto out = folder / "drive";
  const auto plan = folder.write("plan.yaml", "sequences: [{path: '" + shared_drive().string() + "'}]\n");
  CommandProcess first({"simulate", "--out", out, "--sweeps", "2000", "--threads", "1", "--quiet"});
  ASSERT_TRUE(first.wait_until([&] { return fs::exists(sweep_file(out, 0)); }));
  const std::string sweep = slurp(sweep_file(out, 0));
  rilo_fails(4, same_drive_into(out), {out, "another rilo is writing into this folder"});
  rilo_fails(4, {"run", shared_drive(), "--out", out}, {"another rilo is writing into this folder"});
  rilo_fails(4, {"bench", plan, "--out", out}, {"another rilo is writing into this folder"});
  // The first goes on undisturbed.
  const std::size_t done = files_in(out / "times_pt");
  ASSERT_TRUE(first.wait_until([&] { return files_in(out / "times_pt") > done + 1; }));
  first.send(SIGINT);
  EXPECT_EQ(first.wait().exit_code, 130);
  EXPECT_TRUE(slurp(sweep_file(out, 0)) == sweep) << "another drive";
  EXPECT_EQ(files_in(out), files_in(shared_drive()));
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", out, "--json"}).out);
  EXPECT_GT(info["sweeps"], done);
  EXPECT_EQ(info["truth"]["poses"], info["sweeps"]);
}

TEST(SimulateFaults, AKittiSequenceIsNotWrittenOver) {
  const TempDir folder;
  const auto sequence = copy_of_drive(folder);
  for (const char* name : {"times_pt", "meta.json", "poses_start.txt", "poses_end.txt"}) {
    fs::remove_all(sequence / name);
  }
  const std::size_t files = files_below(sequence);
  rilo_fails(4, same_drive_into(sequence), {sequence, "choose an empty folder"});
  EXPECT_EQ(files_below(sequence), files);
}

TEST(SimulateFaults, ARunIsNotWrittenOver) {
  const TempDir folder;
  const auto out = folder / "out";
  CommandProcess run({"run", long_folder(folder, 2000), "--out", out, "--threads", "1", "--quiet"});
  ASSERT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > 0; }));
  rilo_fails(4, same_drive_into(out), {"another rilo is writing into this folder"});
  EXPECT_EQ(files_in(out), 1U);
  run.send(SIGINT);
  EXPECT_EQ(run.wait().exit_code, 130);
}

}  // namespace
}  // namespace rilo::test
