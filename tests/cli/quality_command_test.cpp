// rilo quality.
#include <algorithm>
#include <sstream>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using nlohmann::json;

// The drive has kDriveSweeps sweeps only, of a thin sensor.
const std::vector<std::string> kSmallWindow = {"--window", "10", "--sweep-step", "1", "--radius", "0.6"};

std::vector<std::string> arguments(const std::string& data, const std::string& poses,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = {"quality", data, poses, "--json", "--quiet"};
  for (std::size_t i = 0; i < kSmallWindow.size(); i += 2) {
    if (std::find(more.begin(), more.end(), kSmallWindow[i]) != more.end()) continue;  // an option is given once
    all.insert(all.end(), {kSmallWindow[i], kSmallWindow[i + 1]});
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

json quality(const std::string& data, const std::string& poses, const std::vector<std::string>& more = {}) {
  return json::parse(rilo_succeeds(arguments(data, poses, more)).out);
}

std::string true_poses() { return shared_drive() / "poses_mid.txt"; }

double rms(const json& figures) { return figures["plane_rms_m"]["median"].get<double>(); }

// The lines of the true poses from `first` on.
std::string true_poses_from(std::size_t first) {
  const std::vector<std::string> lines = lines_of(slurp(true_poses()));
  std::string text;
  for (std::size_t i = first; i < lines.size(); ++i) text += lines[i] + "\n";
  return text;
}

// The true poses, every other one moved by `by_m` to the left and up.
std::string shaken_poses(double by_m) {
  std::string text;
  double sign = 1;
  for (const std::string& line : lines_of(slurp(true_poses()))) {
    std::istringstream words(line);
    double value = 0;
    for (int i = 0; words >> value; ++i) text += std::to_string(i == 7 || i == 11 ? value + sign * by_m : value) + " ";
    text += "\n";
    sign = -sign;
  }
  return text;
}

TEST(QualityCommand, TruePosesAreSharp) {
  const TempDir folder;
  const json truth = quality(shared_drive(), true_poses());
  EXPECT_EQ(truth["sweeps"], kDriveSweeps);
  EXPECT_EQ(truth["windows"], 1);
  EXPECT_GT(truth["planar_places"], 300);
  EXPECT_GE(truth["places"], truth["planar_places"]);
  EXPECT_GE(truth["samples"], truth["places"]);
  EXPECT_NEAR(truth["planar_share"].get<double>(),
              truth["planar_places"].get<double>() / truth["samples"].get<double>(), 1e-12);
  EXPECT_LT(truth["bounded_rms_m"], truth["no_plane_m"]);
  EXPECT_LT(rms(truth), 0.03);
  EXPECT_LE(rms(truth), truth["plane_rms_m"]["p75"].get<double>());
  const json wrong = quality(shared_drive(), folder.write("shaken.txt", shaken_poses(0.05)));
  EXPECT_GT(rms(wrong), 1.1 * rms(truth));
  EXPECT_GT(wrong["bounded_rms_m"], truth["bounded_rms_m"]);
  EXPECT_GT(wrong["mean_map_entropy"], truth["mean_map_entropy"]);
}

TEST(QualityCommand, SweepsAreMotionCompensatedWithThePoses) {
  const json compensated = quality(shared_drive(), true_poses());
  const json as_read = quality(shared_drive(), true_poses(), {"--point-times", "none"});
  EXPECT_EQ(compensated["motion_compensation"], true);
  EXPECT_EQ(as_read["motion_compensation"], false);
  EXPECT_LT(compensated["mean_map_entropy"], as_read["mean_map_entropy"]);
}

TEST(QualityCommand, SaysWhereTheRunHadOtherTimes) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "r", "--quiet", "--no-report"});
  const std::string poses = folder / "r/poses_lidar.txt";
  EXPECT_TRUE(quality(shared_drive(), poses)["warnings"].empty());
  const json without = quality(shared_drive(), poses, {"--point-times", "none"})["warnings"];
  ASSERT_EQ(without.size(), 1U);
  EXPECT_NE(without[0].get<std::string>().find("here they are \"none\": see --point-times"), std::string::npos);
}

TEST(QualityCommand, StampsPairAsTheIndexDoes) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "out", "--quiet"});
  const json by_index = quality(shared_drive(), folder / "out" / "poses_lidar.txt");
  const json by_stamp = quality(shared_drive(), folder / "out" / "trajectory.tum");
  EXPECT_EQ(by_stamp["sweeps"], kDriveSweeps);
  EXPECT_NE(by_stamp["protocol"].get<std::string>().find("by stamp"), std::string::npos);
  EXPECT_NEAR(rms(by_stamp), rms(by_index), 0.02 * rms(by_index));
  rilo_fails(2, arguments(shared_drive(), true_poses(), {"--associate", "stamp"}), {"stamp", "KITTI"});
  const json told = quality(shared_drive(), folder / "out" / "trajectory.tum", {"--associate", "index"});
  EXPECT_NE(told["protocol"].get<std::string>().find("by index"), std::string::npos);
}

TEST(QualityCommand, AGapIsTheSameByIndexAndByStamp) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  std::filesystem::remove(sweep_file(drive, 5));
  std::filesystem::remove(drive / "times_pt" / "000005.bin");
  std::vector<std::string> times = lines_of(slurp(drive / "times.txt"));
  times.erase(times.begin() + 5);
  std::string text;
  for (const std::string& line : times) text += line + "\n";
  replace(drive / "times.txt", text);
  rilo_succeeds({"run", drive, "--no-truth", "--out", folder / "out", "--quiet"});
  const json by_index = quality(drive, folder / "out" / "poses_lidar.txt");
  const json by_stamp = quality(drive, folder / "out" / "trajectory.tum");
  EXPECT_EQ(by_stamp["sweeps"], kDriveSweeps - 1);
  EXPECT_NEAR(rms(by_stamp), rms(by_index), 1e-4 * rms(by_index));
}

TEST(QualityCommand, OnlySweepsWithAPoseCount) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "out", "--quiet"});
  const std::vector<std::string> lines = lines_of(slurp(folder / "out" / "trajectory.tum"));
  std::string some;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i != lines.size() - 3) some += lines[i] + "\n";
  }
  EXPECT_EQ(quality(shared_drive(), folder.write("some.tum", some))["sweeps"], kDriveSweeps - 1);
  const std::string swapped = lines[lines.size() - 1] + "\n" + lines[lines.size() - 2] + "\n";
  rilo_fails(3, arguments(shared_drive(), folder.write("swapped.tum", swapped)), {"swapped.tum", "increasing"});
  const std::string elsewhere = "1e6 0 0 0 0 0 0 1\n";
  rilo_fails(3, arguments(shared_drive(), folder.write("elsewhere.tum", elsewhere)), {"elsewhere.tum", "0 of 12"});
}

TEST(QualityCommand, StartAndCountAsOfARun) {
  const TempDir folder;
  const json from_two = quality(shared_drive(), folder.write("from2.txt", true_poses_from(2)), {"--start", "2"});
  EXPECT_EQ(from_two["sweeps"], kDriveSweeps - 2);
  EXPECT_NEAR(rms(from_two), rms(quality(shared_drive(), true_poses())), 0.005);
  EXPECT_EQ(quality(shared_drive(), true_poses(), {"--count", "11"})["sweeps"], 11);
  EXPECT_EQ(from_two["warnings"].size(), 0U);
  const json one_short = quality(shared_drive(), folder.write("from1.txt", true_poses_from(1)));
  EXPECT_EQ(one_short["sweeps"], kDriveSweeps - 1);
  EXPECT_NE(one_short["protocol"].get<std::string>().find("11 poses, for 11 of 12 sweeps"), std::string::npos);
  ASSERT_EQ(one_short["warnings"].size(), 1U);
  EXPECT_NE(one_short["warnings"][0].get<std::string>().find("from1.txt: 11 poses for 12 sweeps"), std::string::npos);
  rilo_fails(3, arguments(shared_drive(), true_poses(), {"--count", "9"}), {"9 sweeps", "window of 10"});
  rilo_fails(3, arguments(shared_drive(), true_poses(), {"--start", "100"}), {"0 sweeps"});
}

TEST(QualityCommand, SameFiguresForAnyNumberOfThreads) {
  const json one = quality(shared_drive(), true_poses(), {"--threads", "1"});
  EXPECT_EQ(one, quality(shared_drive(), true_poses(), {"--threads", "4"}));
}

TEST(QualityCommand, WhatCannotBeUsed) {
  const TempDir folder;
  rilo_fails(3, arguments(folder / "nowhere", true_poses()), {"nowhere"});
  rilo_fails(3, arguments(shared_drive(), folder / "missing.txt"), {"missing.txt"});
  rilo_fails(3, arguments(shared_drive(), folder.write("empty.txt", "")), {"empty.txt"});
  rilo_fails(3, arguments(shared_drive(), folder.write("nan.txt", "nan 0 0 0 0 1 0 0 0 0 1 0\n")),
             {"nan.txt", "line 1"});
  rilo_fails(3, arguments(shared_drive(), true_poses(), {"--radius", "0.001"}), {"no planar place", "--radius"});
  rilo_fails(2, arguments(shared_drive(), true_poses(), {"--window", "4"}), {"(--window) is 4; it must be at least 5"});
  rilo_fails(2, arguments(shared_drive(), true_poses(), {"--max-range", "2"}), {"max_range_m (--max-range)"});
  const auto later = folder.write("later.tum", "900000000 0 0 0 0 0 0 1\n900000000.1 1 0 0 0 0 0 1\n");
  rilo_fails(3, arguments(shared_drive(), later), {"no sweep has a pose", "clock", "--associate index", "--max-gap-s"});
  const std::filesystem::path spoilt = copy_of_drive(folder);
  append(sweep_file(spoilt, 5), 3);
  rilo_fails(3, arguments(spoilt, true_poses()), {"000005.bin"});
}

TEST(QualityCommand, TextForPeople) {
  std::vector<std::string> words = arguments(shared_drive(), true_poses());
  std::erase(words, "--json");
  const Outcome outcome = rilo_succeeds(words);
  expect_parts(outcome.out,
               {"1 window of 10 sweeps", "Planar places", "median", "mm", "All places", "Mean map entropy"});
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace rilo::test
