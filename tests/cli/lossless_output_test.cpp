// Outputs that would cost the user a file are refused before the run: docs/faults.md.
#include <map>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

const std::string kPoint =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    "end_header\n1 2 3\n";

// Every file below `folder` with its bytes.
std::map<std::string, std::string> content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) content[entry.path()] = slurp(entry.path());
  }
  return content;
}

void refused(const TempDir& folder, std::vector<std::string> arguments, const std::vector<std::string>& parts) {
  const auto before = content_of(folder.path());
  arguments.insert(arguments.begin(), "run");
  rilo_fails(4, arguments, parts);
  EXPECT_EQ(content_of(folder.path()), before);
}

TEST(LosslessOutput, TheInputIsNoOutput) {
  const TempDir folder;
  const std::string cloud = folder.write("clouds/map.ply", kPoint);
  refused(folder, {cloud, "--out", folder / "clouds"}, {"map.ply", "is read by this run", "choose"});
  refused(folder, {cloud, "--map", cloud}, {"map.ply", "is read by this run"});
  fs::create_symlink(cloud, folder / "link.ply");
  refused(folder, {cloud, "--map", folder / "link.ply"}, {"link.ply", "is read by this run"});
}

TEST(LosslessOutput, AConfigurationIsNotReplacedByItsDump) {
  const TempDir folder;
  const std::string config = folder.write("mine/config.yaml", "# years of work\nthreads: 1\n");
  refused(folder, {shared_drive(), "--config", config, "--out", folder / "mine"},
          {"config.yaml", "is read by this run"});
}

TEST(LosslessOutput, ResultsDoNotGoAmongTheData) {
  const TempDir folder;
  const auto sweeps = long_folder(folder, 3);
  refused(folder, {sweeps, "--out", sweeps}, {sweeps, "holds data", "choose a folder of its own"});
  refused(folder, {sweep_file(shared_drive(), 0), "--out", sweeps}, {sweeps, "holds data"});
  refused(folder, {sweeps, "--map", sweeps / "1.ply"}, {"1.ply", "among the data"});
  const auto drive = copy_of_drive(folder);
  refused(folder, {drive, "--out", drive / "velodyne"}, {"velodyne", "holds data"});
  refused(folder, {drive, "--out", drive / "x" / ".."}, {"holds data"});
}

TEST(LosslessOutput, AFolderWithinTheDataWorksAgainAndAgain) {
  const TempDir folder;
  const auto sweeps = long_folder(folder, 3);
  for (int i = 0; i < 2; ++i) rilo_succeeds({"run", sweeps, "--out", sweeps / "results", "--map", "map.ply"});
  rilo_succeeds({"run", sweeps, "--out", sweeps / "results"});
  EXPECT_FALSE(fs::exists(sweeps / "results" / "map.ply")) << "of an earlier run";
}

TEST(LosslessOutput, FilesThatNoRunHasLeftStay) {
  const TempDir folder;
  for (const char* name : {"trajectory.csv", "report.html", "config.yaml", "metrics.json"}) {
    const std::string file = folder.write(std::string(name) + ".d/" + name, "mine");
    refused(folder, {shared_drive(), "--out", fs::path(file).parent_path()}, {name, "no earlier run has left it"});
  }
}

TEST(LosslessOutput, AMapReplacesMapsAndNothingElse) {
  const TempDir folder;
  const fs::path out = folder / "out";
  const std::string scan = folder.write("scan.ply", kPoint);
  const std::string notes = folder.write("notes.pcd", "mine");
  refused(folder, {shared_drive(), "--map", scan}, {"scan.ply", "no map of an earlier run", "choose another --map"});
  refused(folder, {shared_drive(), "--map", notes, "--out", out}, {"notes.pcd", "no map of an earlier run"});
  for (int i = 0; i < 2; ++i) {
    rilo_succeeds({"run", shared_drive(), "--count", "3", "--map", folder / "map.pcd", "--quiet"});
    rilo_succeeds({"run", shared_drive(), "--count", "3", "--map", "map.ply", "--out", out, "--quiet"});
  }
  replace(out / "map.ply", kPoint);  // put there since
  refused(folder, {shared_drive(), "--out", out}, {"map.ply", "no map of an earlier run"});
}

TEST(LosslessOutput, WhatAKilledRunLeftIsReplaced) {
  const TempDir folder;
  const auto out = folder / "out";
  rilo_succeeds({"run", shared_drive(), "--count", "3", "--out", out, "--quiet"});
  fs::remove(out / "metrics.json");
  replace(out / "poses_lidar.partial.txt", slurp(out / "poses_lidar.txt"));
  rilo_succeeds({"run", shared_drive(), "--count", "3", "--out", out, "--quiet"});
  EXPECT_TRUE(fs::exists(out / "metrics.json"));
}

}  // namespace
}  // namespace rilo::test
