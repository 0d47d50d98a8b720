// Runs that do not reach their end.
#include <csignal>

#include "cli/drives.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

constexpr std::size_t kMoreThanIsDone = 2000;  // about a minute's work
constexpr std::size_t kSweepsBefore = 3;

// From /proc: whether the process handles the signal rather than being ended by it.
bool handles(pid_t pid, int signal) {
  for (const std::string& line : lines_with(slurp("/proc/" + std::to_string(pid) + "/status"), "SigCgt:")) {
    return (std::stoull(line.substr(line.find('\t')), nullptr, 16) >> (signal - 1) & 1U) != 0;
  }
  return false;
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

// What the command inherits: the tests themselves may have been started with nohup.
class InheritedHangup {
 public:
  explicit InheritedHangup(void (*action)(int)) : before_(std::signal(SIGHUP, action)) {}
  ~InheritedHangup() { std::signal(SIGHUP, before_); }
  InheritedHangup(const InheritedHangup&) = delete;
  InheritedHangup& operator=(const InheritedHangup&) = delete;

 private:
  void (*before_)(int);
};

TEST(InterruptedRun, AClosedTerminalLeavesAValidPartialResult) {
  const InheritedHangup usual(SIG_DFL);
  expect_valid_partial_result(SIGHUP, 129);
}

TEST(InterruptedRun, WithNohupItOutlivesTheTerminal) {
  const InheritedHangup ignored(SIG_IGN);
  const TempDir folder;
  const auto out = folder / "out";
  CommandProcess run({"run", long_folder(folder, kMoreThanIsDone), "--out", out, "--threads", "1"});
  ASSERT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") >= kSweepsBefore; }));
  EXPECT_FALSE(handles(run.pid(), SIGHUP));
  run.send(SIGHUP);
  const std::size_t done = complete_lines(out / "poses_lidar.partial.txt");
  EXPECT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > done + kSweepsBefore; }));
}

// Stopped between the two, so that the second comes before the results of the first however slow the test is.
TEST(InterruptedRun, ASecondCtrlCEndsItAtOnce) {
  constexpr int kMostTries = 20;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    const TempDir folder;
    const auto out = folder / "out";
    CommandProcess run({"run", long_folder(folder, kMoreThanIsDone), "--out", out, "--threads", "1"});
    ASSERT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") >= kSweepsBefore; }));
    ASSERT_TRUE(handles(run.pid(), SIGINT));
    run.send(SIGINT);
    ASSERT_TRUE(run.wait_until([&] { return !handles(run.pid(), SIGINT); }));
    run.send(SIGSTOP);
    if (std::filesystem::exists(out / "poses_lidar.txt")) continue;  // too late: it is writing already
    run.send(SIGINT);
    run.send(SIGCONT);
    const Outcome outcome = run.wait();
    EXPECT_EQ(outcome.signal, SIGINT) << outcome.err;
    EXPECT_EQ(files_in(out), 1U) << "more than a killed run leaves";
    EXPECT_GE(read_kitti_poses(out / "poses_lidar.partial.txt").size(), kSweepsBefore);
    return;
  }
  ADD_FAILURE() << "the results were there before a second signal could be sent, each time";
}

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

// A report compares them with the true poses of these sweeps, not of the first ones.
TEST(InterruptedRun, AKilledRunSaysWhichSweepsItHas) {
  const TempDir folder;
  const auto out = folder / "killed";
  CommandProcess run({"run", long_folder(folder, kMoreThanIsDone), "--start", "7", "--out", out, "--threads", "1"});
  ASSERT_TRUE(run.wait_until([&] { return complete_lines(out / "poses_lidar.partial.txt") > kSweepsBefore; }));
  run.send(SIGKILL);
  run.wait();
  EXPECT_TRUE(slurp(out / "poses_lidar.partial.txt").starts_with("# sweep 7\n1.0"));
  EXPECT_GE(read_kitti_poses(out / "poses_lidar.partial.txt").size(), kSweepsBefore);
}

TEST(InterruptedRun, ASimulationStopsToo) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TempDir folder;
    const auto out = folder / "drive";
    CommandProcess simulate({"simulate", "--out", out, "--sensor", "hdl64", "--sweeps", "2000", "--threads", "1"});
    EXPECT_TRUE(simulate.wait_until([&] { return std::filesystem::exists(sweep_file(out, 0)); }));
    simulate.send(signal);
    EXPECT_EQ(simulate.wait().exit_code, 128 + signal);
    const auto info = nlohmann::json::parse(rilo_succeeds({"info", out, "--json"}).out);
    EXPECT_GE(info["sweeps"], 1);
    EXPECT_EQ(info["truth"]["poses"], info["sweeps"]);
  }
}

}  // namespace
}  // namespace rilo::test
