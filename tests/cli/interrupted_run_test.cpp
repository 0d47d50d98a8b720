// Runs that do not reach their end.
#include <algorithm>
#include <csignal>

#include "cli/drives.hpp"
#include "rilo/io/pose_reader.hpp"

namespace rilo::test {
namespace {

constexpr std::size_t kMoreThanIsDone = 2000;  // about a minute's work
constexpr std::size_t kSweepsBefore = 3;

std::size_t complete_lines(const std::filesystem::path& file) {
  const std::string text = std::filesystem::exists(file) ? slurp(file) : "";
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Sends the signal once some sweeps are done.
Outcome interrupted_by(int signal, const std::filesystem::path& sweeps, const std::filesystem::path& out) {
  CommandProcess run({"run", sweeps, "--out", out, "--threads", "1"});
  EXPECT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") >= kSweepsBefore; }));
  run.send(signal);
  return run.wait();
}

void expect_valid_partial_result(int signal, int exit_code) {
  const TempDir folder;
  const auto out = folder / "out";
  const Outcome run = interrupted_by(signal, long_folder(folder, kMoreThanIsDone), out);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(run.signal, 0);
  EXPECT_NE(run.out.find("interrupted"), std::string::npos) << run.out;
  const auto metrics = json_file(out / "metrics.json");
  EXPECT_EQ(metrics["interrupted"], true);
  const auto frames = metrics["frames"].get<std::size_t>();
  EXPECT_GE(frames, kSweepsBefore);
  EXPECT_LT(frames, kMoreThanIsDone);
  EXPECT_EQ(read_kitti_poses(out / "poses_lidar.txt").size(), frames);
  EXPECT_EQ(read_tum(out / "trajectory.tum").size(), frames);
  EXPECT_EQ(lines_of(slurp(out / "sweeps.csv")).size(), frames + 1);
  EXPECT_NE(slurp(out / "report.html").find("interrupted"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out / "poses_lidar.partial.txt"));
}

TEST(InterruptedRun, CtrlCLeavesAValidPartialResult) { expect_valid_partial_result(SIGINT, 130); }

TEST(InterruptedRun, TerminationLeavesAValidPartialResult) { expect_valid_partial_result(SIGTERM, 143); }

TEST(InterruptedRun, AKilledRunLeavesAValidPrefix) {
  const TempDir folder;
  const auto sweeps = long_folder(folder, kMoreThanIsDone);
  const Outcome run = interrupted_by(SIGKILL, sweeps, folder / "killed");
  EXPECT_EQ(run.signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(folder / "killed" / "poses_lidar.txt"));
  const auto partial = read_kitti_poses(folder / "killed" / "poses_lidar.partial.txt");
  ASSERT_GE(partial.size(), kSweepsBefore);
  rilo_succeeds({"run", sweeps, "--count", std::to_string(partial.size()), "--out", folder / "whole", "--threads", "1",
                 "--no-report", "--quiet"});
  const auto whole = read_kitti_poses(folder / "whole" / "poses_lidar.txt");
  ASSERT_EQ(whole.size(), partial.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_LT((whole[i].matrix() - partial[i].matrix()).cwiseAbs().maxCoeff(), 1e-7) << "sweep " << i;
  }
}

TEST(InterruptedRun, ASimulationStopsToo) {
  const TempDir folder;
  const auto out = folder / "drive";
  CommandProcess simulate({"simulate", "--out", out, "--sensor", "hdl64", "--sweeps", "2000", "--threads", "1"});
  EXPECT_TRUE(simulate.wait_until([&] { return std::filesystem::exists(sweep_file(out, 0)); }));
  simulate.send(SIGINT);
  EXPECT_EQ(simulate.wait().exit_code, 130);
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", out, "--json"}).out);
  EXPECT_GE(info["sweeps"], 1);
  EXPECT_EQ(info["truth"]["poses"], info["sweeps"]);
}

}  // namespace
}  // namespace rilo::test
