// rilo simulate.
#include "cli/drives.hpp"

namespace rilo::test {
namespace {

TEST(SimulateCommand, SameBytesForAnyNumberOfThreads) {
  const TempDir folder;
  const auto simulate = [&](const std::string& name, const std::string& threads, const std::string& seed) {
    rilo_succeeds({"simulate", "--out", folder / name, "--sensor", "vlp16", "--sweeps", "3", "--start", "10", "--seed",
                   seed, "--threads", threads});
    return slurp(sweep_file(folder / name, 2)) + slurp(folder / name / "poses.txt") +
           slurp(folder / name / "times.txt");
  };
  const std::string bytes = simulate("one", "1", "5");
  EXPECT_GT(bytes.size(), 100000U);
  EXPECT_EQ(simulate("three", "3", "5"), bytes);
  EXPECT_NE(simulate("other", "1", "6"), bytes);
}

TEST(SimulateCommand, ADriveHasEverythingARunNeeds) {
  const auto& drive = shared_drive();
  EXPECT_EQ(files_in(drive / "velodyne"), kDriveSweeps);
  EXPECT_EQ(files_in(drive / "times_pt"), kDriveSweeps);
  for (const char* file : {"poses.txt", "poses_mid.txt", "times.txt"}) {
    EXPECT_EQ(lines_of(slurp(drive / file)).size(), kDriveSweeps) << file;
  }
  EXPECT_NE(slurp(drive / "calib.txt").find("Tr:"), std::string::npos);
}

TEST(SimulateCommand, NonsenseIsRefused) {
  const TempDir folder;
  const std::string out = folder / "drive";
  rilo_fails(2, {"simulate", "--out", out, "--noise", "-1"}, {"noise"});
  rilo_fails(2, {"simulate", "--out", out, "--dropout", "1.5"}, {"dropout"});
  rilo_fails(2, {"simulate", "--out", out, "--speed", "nan"}, {"speed"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace rilo::test
