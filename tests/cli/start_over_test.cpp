// A recording is run again from its first sweep with what a first pass says about the sensor.
#include <gtest/gtest.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kSweeps = 40;

// Any estimate counts as certain, so that a short drive of a sensor without error will do.
std::vector<std::string> arguments(const fs::path& data, const fs::path& out) {
  return {"run", data, "--out", out, "--point-times", "none", "--set", "elevation.significance=0", "--no-report"};
}

std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

TEST(StartOver, WithWhatTheFirstPassSays) {
  const TempDir folder;
  const fs::path data = long_folder(folder, kSweeps);
  const Outcome run = rilo_succeeds(arguments(data, folder / "two"));
  const json metrics = json_file(folder / "two" / "metrics.json");
  ASSERT_TRUE(metrics["started_over_after_sweeps"].is_number()) << metrics;
  EXPECT_EQ(metrics["started_over_after_sweeps"], kSweeps);
  EXPECT_NE(metrics["elevation_initial_deg"], 0.0);
  EXPECT_EQ(metrics["frames"], kSweeps);
  EXPECT_EQ(lines_of(slurp(folder / "two" / "poses_lidar.txt")).size(), kSweeps);
  EXPECT_NE(run.err.find("restarting with them"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("restarted after"), std::string::npos) << run.out;

  // The configuration that is left tells the whole story: with it the same poses come out.
  rilo_succeeds({"run", data, "--out", folder / "again", "--point-times", "none", "--no-report", "--config",
                 folder / "two" / "config.yaml"});
  EXPECT_EQ(slurp(folder / "again" / "poses_lidar.txt"), slurp(folder / "two" / "poses_lidar.txt"));
}

TEST(StartOver, NotInOnePass) {
  const TempDir folder;
  const fs::path data = long_folder(folder, kSweeps);
  rilo_succeeds(with(arguments(data, folder / "one"), {"--one-pass"}));
  const json metrics = json_file(folder / "one" / "metrics.json");
  EXPECT_TRUE(metrics["started_over_after_sweeps"].is_null());
  EXPECT_NE(metrics["elevation_offset_applied_deg"], 0.0);
  EXPECT_EQ(metrics["frames"], kSweeps);
}

TEST(StartOver, StartAndCountStillHold) {
  const TempDir folder;
  const fs::path data = long_folder(folder, kSweeps);
  rilo_succeeds(with(arguments(data, folder / "part"), {"--start", "5", "--count", "30"}));
  const json metrics = json_file(folder / "part" / "metrics.json");
  EXPECT_TRUE(metrics["started_over_after_sweeps"].is_number());
  EXPECT_EQ(metrics["frames"], 30);
  EXPECT_EQ(lines_of(slurp(folder / "part" / "sweeps.csv")).at(1).substr(0, 2), "5,");
}

}  // namespace
}  // namespace rilo::test
