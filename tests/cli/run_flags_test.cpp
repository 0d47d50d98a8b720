// Options of rilo run.
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using nlohmann::json;

json metrics_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"run", shared_drive()});
  arguments.emplace_back("--json");
  return json::parse(rilo_succeeds(arguments).out);
}

TEST(RunFlags, StartAndCount) {
  const TempDir folder;
  const json metrics = metrics_of({"--start", "3", "--count", "4", "--out", folder / "out", "--no-report"});
  EXPECT_EQ(metrics["frames"], 4);
  EXPECT_EQ(metrics["evaluation"]["poses"], 4);
  EXPECT_LT(metrics["evaluation"]["ape_unaligned_m"]["rmse"], 0.25) << "sweeps matched to the truth of others";
  const auto lines = lines_of(slurp(folder / "out" / "sweeps.csv"));
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_TRUE(lines[1].starts_with("3,"));
  EXPECT_TRUE(lines[4].starts_with("6,"));
}

TEST(RunFlags, CountBeyondTheEndAndStartBeyondTheEnd) {
  EXPECT_EQ(metrics_of({"--start", "10", "--count", "100"})["frames"], 2);
  rilo_fails(3, {"run", shared_drive(), "--start", "12"}, {"no sweep"});
}

TEST(RunFlags, AStartBeyondTheEndNamesBothNumbers) {
  rilo_fails(3, {"run", shared_drive(), "--start", "500"}, {"start 500 is past the last of 12 sweeps"});
}

TEST(RunFlags, WithoutOutItSaysThatNothingIsKept) {
  const TempDir folder;
  const std::string note = "results are not kept; --out FOLDER keeps them";
  EXPECT_NE(rilo_succeeds({"run", shared_drive(), "--count", "1"}).err.find(note), std::string::npos);
  EXPECT_EQ(rilo_succeeds({"run", shared_drive(), "--count", "1", "--out", folder / "out"}).err.find(note),
            std::string::npos);
}

TEST(RunFlags, WithoutPointTimesItSaysWhatToDo) {
  const TempDir folder;
  const auto sweeps = long_folder(folder, 2);
  const auto notes = [&](const std::string& times) {
    return lines_with(rilo_succeeds({"run", sweeps, "--point-times", times, "--count", "2"}).err,
                      "rilo: note: no per-point times")
        .size();
  };
  EXPECT_EQ(notes("auto"), 1U);
  EXPECT_EQ(notes("none"), 0U);
  EXPECT_EQ(notes("azimuth"), 0U);
}

// A solid-state sensor.
TEST(RunFlags, WhatSpinsIsNotSaidOfPointsInOneDirection) {
  const TempDir folder;
  std::string window;
  for (int i = 0; i < 2000; ++i) {
    const float azimuth = 0.6F * std::sin(0.1F * static_cast<float>(i));
    window +=
        bytes_of<float>({8.0F * std::cos(azimuth), 8.0F * std::sin(azimuth), 1e-3F * static_cast<float>(i), 0.0F});
  }
  folder.write("000000.bin", window);
  const std::string said = rilo_succeeds({"run", folder.path(), "--one-pass"}).err;
  EXPECT_NE(said.find("no per-point times"), std::string::npos) << said;
  EXPECT_EQ(said.find("spinning"), std::string::npos) << said;
}

TEST(RunFlags, AnEmptyFirstSweepDoesNotSayThatTimesAreMissing) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  replace(sweep_file(drive, 0), "");
  replace(drive / "times_pt" / "000000.bin", "");
  const Outcome outcome = rilo_succeeds({"run", drive, "--count", "4"});
  EXPECT_EQ(outcome.err.find("no per-point times"), std::string::npos) << outcome.err;
}

TEST(RunFlags, TheFramesOfTheTrajectoryDiffer) {
  const TempDir folder;
  const std::vector<std::string> run = {"run", shared_drive(), "--count", "1", "--out", folder / "out"};
  const auto refused = [&](const std::vector<std::string>& frames, const std::vector<std::string>& parts) {
    std::vector<std::string> command = run;
    command.insert(command.end(), frames.begin(), frames.end());
    rilo_fails(2, command, parts);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  };
  refused({"--odom-frame", "map", "--lidar-frame", "/map"}, {"both map", "two frames"});
  refused({"--lidar-frame", "odom"}, {"both odom"});
  refused({"--odom-frame", ""}, {"--odom-frame", "the name of a frame"});
}

TEST(RunFlags, RawPointsWithoutTimesAreFoundOut) {
  const TempDir folder;
  const auto drive = folder / "drive";
  rilo_succeeds({"simulate", "--out", drive, "--sensor", "vlp16", "--sweeps", "25", "--start", "10", "--quiet"});
  std::filesystem::remove_all(drive / "times_pt");
  EXPECT_THAT(rilo_succeeds({"info", drive}).out, testing::HasSubstr("(finds out that the points are raw)"));
  const auto run = [&](const std::string& out, const std::vector<std::string>& flags) {
    std::vector<std::string> command = {"run", drive, "--out", folder / out, "--no-report"};
    command.insert(command.end(), flags.begin(), flags.end());
    const Outcome outcome = rilo_succeeds(command);
    return std::pair(outcome.err.find("taken as raw") != std::string::npos, slurp(folder / out / "poses_lidar.txt"));
  };
  const auto [found, poses] = run("auto", {});
  EXPECT_TRUE(found);
  EXPECT_EQ(run("order", {"--point-times", "order"}), std::pair(false, poses));
  rilo_fails(3, {"run", drive, "--point-times", "data"}, {"no per-point times", "--point-times data"});
  const auto none = run("none", {"--point-times", "none", "--one-pass"});
  EXPECT_NE(none.second, poses);
  EXPECT_EQ(run("one", {"--one-pass"}), none);
  const auto metrics = json_file(folder / "auto" / "metrics.json");
  EXPECT_TRUE(metrics["point_times"].get<std::string>().starts_with("order of the points"));
  EXPECT_EQ(metrics["compensation"]["raw"], true);
  EXPECT_EQ(metrics["compensation"]["compensated"], false);
  EXPECT_EQ(metrics["compensation"]["times"], "order");
  EXPECT_GE(metrics["compensation"]["sweeps"], 10);
  EXPECT_LE(metrics["compensation"]["better"], metrics["compensation"]["sweeps"]);
  EXPECT_FALSE(json_file(folder / "none" / "metrics.json").contains("compensation"));
  rilo_succeeds({"run", drive, "--out", folder / "report", "--quiet"});
  EXPECT_THAT(slurp(folder / "report" / "report.html"), testing::HasSubstr("of the beams: taken as raw"));
}

TEST(RunFlags, AMapWithoutAFolderGoesIntoOutAndAStaleOneGoesAway) {
  const TempDir folder;
  const auto out = folder / "out";
  const std::vector<std::string> run = {"run", shared_drive(), "--count", "2", "--no-report", "--quiet", "--out", out};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), run.begin(), run.end());
    rilo_succeeds(more);
  };
  with({"--map", "map.ply"});
  EXPECT_TRUE(std::filesystem::exists(out / "map.ply"));
  with({"--map", out / "map.pcd"});
  EXPECT_TRUE(std::filesystem::exists(out / "map.pcd"));
  EXPECT_FALSE(std::filesystem::exists(out / "map.ply")) << "of an earlier run";
  with({"--map", "other.ply"});
  with({});
  EXPECT_FALSE(std::filesystem::exists(out / "map.pcd")) << "of an earlier run";
  EXPECT_TRUE(std::filesystem::exists(out / "other.ply")) << "may be somebody's";
}

TEST(RunFlags, AMapIsNamedInTheSummary) {
  const TempDir folder;
  const std::string map = folder / "map.ply";
  EXPECT_THAT(rilo_succeeds({"run", shared_drive(), "--count", "2", "--map", map}).out,
              testing::HasSubstr("map             " + map + "\n"));
}

TEST(RunFlags, OptionsWithoutTheOneTheyBelongToAreNamed) {
  const std::vector<std::string> run = {"run", shared_drive(), "--count", "2", "--map-voxel", "0.5", "--map-normals"};
  const auto warnings = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = run;
    command.insert(command.end(), more.begin(), more.end());
    return lines_with(rilo_succeeds(command).err, "rilo: warning: --");
  };
  const auto idle = warnings({"--map-intensity", "--lidar-frame", "velodyne", "--view-address", "127.0.0.1"});
  EXPECT_EQ(idle.size(), 5U);
  EXPECT_EQ(idle.at(0), "rilo: warning: --map-voxel is ignored: it is of no use without --map");
  const TempDir folder;
  EXPECT_TRUE(warnings({"--map", folder / "map.ply"}).empty());
  EXPECT_TRUE(warnings({"--quiet"}).empty());
}

TEST(RunFlags, JsonIsTheMetricsFile) {
  const TempDir folder;
  const json printed = metrics_of({"--count", "3", "--out", folder / "out"});
  EXPECT_EQ(printed, json_file(folder / "out" / "metrics.json"));
}

TEST(RunFlags, QuietPrintsNothing) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  replace(drive / "poses_mid.txt", "no poses\n");  // a warning, were it not quiet
  const Outcome run = rilo_succeeds({"run", drive, "--quiet", "--count", "3", "--out", folder / "out"});
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(rilo_succeeds({"simulate", "--quiet", "--sweeps", "2", "--sensor", "vlp16", "--out", folder / "d"}).out,
            "");
}

TEST(RunFlags, PointTimesAndElevationCorrectionAreReported) {
  const json azimuth = metrics_of({"--count", "3", "--point-times", "azimuth", "--elevation-correction", "0.205"});
  EXPECT_EQ(azimuth["elevation_correction_deg"], 0.205);
  EXPECT_EQ(azimuth["motion_compensation"], true);
  EXPECT_NE(azimuth["point_times"].get<std::string>().find("azimuth"), std::string::npos) << azimuth["point_times"];
  const json none = metrics_of({"--count", "3", "--point-times", "none"});
  EXPECT_EQ(none["elevation_correction_deg"], 0.0);
  EXPECT_EQ(none["motion_compensation"], false);
  const json off = metrics_of({"--count", "3", "--set", "preprocess.deskew=false"});
  EXPECT_EQ(off["motion_compensation"], false);
}

TEST(RunFlags, TheElevationCorrectionChangesThePoints) {
  const TempDir folder;
  const auto map = [&](const std::string& degrees) {
    const auto file = folder / (degrees + ".ply");
    rilo_succeeds({"run", shared_drive(), "--count", "2", "--quiet", "--map", file, "--elevation-correction", degrees});
    return slurp(file);
  };
  EXPECT_NE(map("0"), map("0.205"));
}

TEST(RunFlags, PointTimesOnDemand) {
  const TempDir folder;
  const auto sweeps = long_folder(folder, 3);
  rilo_fails(3, {"run", sweeps, "--point-times", "data"}, {"per-point times"});
  EXPECT_EQ(metrics_of({"--count", "2", "--point-times", "data"})["motion_compensation"], true);
}

}  // namespace
}  // namespace rilo::test
