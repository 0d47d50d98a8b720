// What a run leaves behind.
#include <algorithm>
#include <cmath>
#include <regex>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using nlohmann::json;

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = line.find(separator); end != std::string::npos; end = line.find(separator, begin)) {
    parts.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(line.substr(begin));
  return parts;
}

// All of these are there and numbers.
void expect_numbers(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    ASSERT_TRUE(object.contains(key)) << key << " in " << object;
    EXPECT_TRUE(object[key].is_number()) << key << " in " << object;
  }
}

void expect_evaluation(const json& evaluation) {
  EXPECT_EQ(evaluation["poses"], kDriveSweeps);
  expect_numbers(evaluation, {"path_m", "t_rel_pct", "r_rel_deg_per_100m", "end_error_m"});
  for (const char* key : {"ape_m", "ape_unaligned_m", "rpe_frame_m", "rpe_metre_m_per_m"}) {
    expect_numbers(evaluation[key], {"rmse", "mean", "std", "median", "max"});
  }
  EXPECT_GT(evaluation["path_m"], 1.0);
  EXPECT_LT(evaluation["ape_unaligned_m"]["rmse"], 0.25);
  EXPECT_NE(evaluation["truth"].get<std::string>().find("poses_mid.txt"), std::string::npos);
}

void expect_metrics(const json& metrics) {
  EXPECT_EQ(metrics["frames"], kDriveSweeps);
  expect_numbers(metrics["ms"], {"mean", "median", "p95", "p99", "max"});
  EXPECT_LE(metrics["ms"]["median"], metrics["ms"]["p95"]);
  EXPECT_LE(metrics["ms"]["p95"], metrics["ms"]["p99"]);
  EXPECT_LE(metrics["ms"]["p99"], metrics["ms"]["max"]);
  EXPECT_GT(metrics["peak_rss_mb"], 1.0);
  EXPECT_EQ(metrics["threads"], 2);
  EXPECT_EQ(metrics["pose_instant"], "mid");
  EXPECT_EQ(metrics["interrupted"], false);
  EXPECT_EQ(metrics["bad_sweeps"], 0);
  EXPECT_EQ(metrics["elevation_correction_deg"], 0.0);
  EXPECT_TRUE(metrics.contains("elevation_offset_deg"));
  EXPECT_TRUE(metrics.contains("elevation_offset_sigma_deg"));
  EXPECT_EQ(metrics["elevation_offset_applied_deg"], 0.0);
  EXPECT_TRUE(metrics.at("started_over_after_sweeps").is_null());
  EXPECT_EQ(metrics["motion_compensation"], true);
  EXPECT_EQ(metrics["warnings"], json::array());
  std::size_t sweeps = 0;
  for (const auto& [name, count] : metrics["status"].items()) sweeps += count.get<std::size_t>();
  EXPECT_EQ(sweeps, kDriveSweeps);
  EXPECT_EQ(metrics["status"]["lost"], 0);
}

void expect_tum(const std::string& text) {
  const std::regex number(R"(-?\d+\.\d{9,})");
  const auto lines = lines_with(text, "");
  std::size_t poses = 0;
  for (const std::string& line : lines) {
    if (line.starts_with("#")) continue;
    ++poses;
    const auto words = split(line, ' ');
    ASSERT_EQ(words.size(), 8U) << line;
    for (const std::string& word : words) EXPECT_TRUE(std::regex_match(word, number)) << word << " in " << line;
    EXPECT_EQ(words[0].size() - words[0].find('.'), 10U) << "stamps to the nanosecond: " << words[0];
  }
  EXPECT_EQ(poses, kDriveSweeps);
}

void expect_kitti(const std::string& text) {
  const auto lines = lines_of(text);
  EXPECT_EQ(lines.size(), kDriveSweeps);
  for (const std::string& line : lines) {
    const auto words = split(line, ' ');
    EXPECT_EQ(words.size(), 12U) << line;
    for (const std::string& word : words) EXPECT_TRUE(std::isfinite(std::stod(word))) << line;
  }
}

void expect_csv(const std::string& text) {
  const auto lines = lines_of(text);
  ASSERT_EQ(lines.size(), kDriveSweeps + 1);
  const auto header = split(lines.front(), ',');
  EXPECT_EQ(header.front(), "sweep");
  EXPECT_GT(header.size(), 20U);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = split(lines[i], ',');
    EXPECT_EQ(cells.size(), header.size()) << lines[i];
    EXPECT_EQ(cells.front(), std::to_string(i - 1));
    for (const std::string& cell : cells) EXPECT_NE(cell, "") << lines[i];
  }
}

// Nothing is fetched: no address but names of XML vocabularies, no file beside it.
void expect_self_contained(const std::string& html) {
  EXPECT_GT(html.size(), 10000U);
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_NE(html.find("<svg"), std::string::npos);
  for (const char* loads : {"<link", "<iframe", "src=\"http", "src=\"/", "href=\"http", "@import", "url(http"}) {
    EXPECT_EQ(html.find(loads), std::string::npos) << loads;
  }
}

TEST(RunOutputs, AllFilesArePresentAndParse) {
  const TempDir folder;
  const auto out = folder / "results" / "nested";
  const Outcome run = rilo_succeeds({"run", shared_drive(), "--out", out, "--threads", "2"});
  expect_parts(run.out, {"12 sweeps", "time per sweep", "peak memory", "pose time", "APE"});
  const json metrics = json_file(out / "metrics.json");
  expect_metrics(metrics);
  ASSERT_TRUE(metrics.contains("evaluation"));
  expect_evaluation(metrics["evaluation"]);
  expect_tum(slurp(out / "trajectory.tum"));
  expect_kitti(slurp(out / "poses_lidar.txt"));
  expect_kitti(slurp(out / "poses_camera.txt"));
  expect_csv(slurp(out / "sweeps.csv"));
  expect_self_contained(slurp(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "config.yaml"));
  EXPECT_TRUE(std::filesystem::exists(out / "calibration.yaml"));
  const std::size_t bags = std::filesystem::exists(out / "trajectory.bag") ? 1 : 0;  // where ROS' library is
  EXPECT_EQ(files_in(out), 10U + bags) << "nothing temporary is left";
}

TEST(RunOutputs, ConfigurationThatWasUsedGivesTheSamePoses) {
  const TempDir folder;
  const std::string set = "preprocess.max_range_m=40";
  rilo_succeeds({"run", shared_drive(), "--out", folder / "set", "--count", "6", "--set", set, "--no-report"});
  rilo_succeeds({"run", shared_drive(), "--out", folder / "file", "--count", "6", "--config",
                 folder / "set" / "config.yaml", "--no-report"});
  rilo_succeeds({"run", shared_drive(), "--out", folder / "default", "--count", "6", "--no-report"});
  EXPECT_EQ(slurp(folder / "set" / "config.yaml"), slurp(folder / "file" / "config.yaml"));
  EXPECT_EQ(slurp(folder / "set" / "poses_lidar.txt"), slurp(folder / "file" / "poses_lidar.txt"));
  EXPECT_NE(slurp(folder / "set" / "poses_lidar.txt"), slurp(folder / "default" / "poses_lidar.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder / "set" / "report.html"));
}

TEST(RunOutputs, SameBytesForOneTwoAndFourThreads) {
  const TempDir folder;
  for (const std::string threads : {"1", "2", "4"}) {
    rilo_succeeds({"run", shared_drive(), "--out", folder / threads, "--threads", threads, "--no-report", "--quiet"});
    EXPECT_EQ(json_file(folder / threads / "metrics.json")["threads"], std::stoi(threads));
  }
  for (const char* name : {"poses_lidar.txt", "poses_camera.txt", "trajectory.tum"}) {
    const std::string bytes = slurp(folder / "1" / name);
    EXPECT_GT(bytes.size(), 500U);
    EXPECT_EQ(slurp(folder / "2" / name), bytes) << name;
    EXPECT_EQ(slurp(folder / "4" / name), bytes) << name;
  }
}

TEST(RunOutputs, NoCameraPosesWithoutACalibration) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  const auto out = folder / "out";
  rilo_succeeds({"run", drive, "--out", out, "--count", "3"});
  EXPECT_TRUE(std::filesystem::exists(out / "poses_camera.txt"));
  std::filesystem::remove(drive / "calib.txt");
  rilo_succeeds({"run", drive, "--out", out, "--count", "3"});
  EXPECT_TRUE(std::filesystem::exists(out / "poses_lidar.txt"));
  EXPECT_FALSE(std::filesystem::exists(out / "poses_camera.txt"));
}

TEST(RunOutputs, MapsAreReadable) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--map", folder / "map.ply", "--count", "4", "--quiet"});
  rilo_succeeds({"run", shared_drive(), "--map", folder / "map.pcd", "--count", "4", "--quiet"});
  const RawCloud ply = read_ply(folder / "map.ply");
  const RawCloud pcd = read_pcd(folder / "map.pcd");
  EXPECT_GT(ply.points.size(), 1000U);
  EXPECT_EQ(ply.points, pcd.points);
  for (const Eigen::Vector3f& point : ply.points) ASSERT_TRUE(point.allFinite() && point.norm() < 250.0F);
}

TEST(RunOutputs, MapsHaveTheColumnsAskedFor) {
  const TempDir folder;
  const std::vector<std::string> run = {"run", shared_drive(), "--count", "4", "--quiet", "--map"};
  const auto with = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = run;
    arguments.push_back(folder / file);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  rilo_succeeds(with("fine.ply", {}));
  rilo_succeeds(with("coarse.ply", {"--map-voxel", "1", "--map-normals", "--map-intensity"}));
  const RawCloud fine = read_ply(folder / "fine.ply");
  const RawCloud coarse = read_ply(folder / "coarse.ply");
  EXPECT_TRUE(fine.intensities.empty());
  EXPECT_LT(2 * coarse.points.size(), fine.points.size());
  ASSERT_EQ(coarse.intensities.size(), coarse.points.size());
  EXPECT_NE(*std::max_element(coarse.intensities.begin(), coarse.intensities.end()), 0.0F);
  EXPECT_NE(slurp(folder / "coarse.ply").find("property float nz"), std::string::npos);
  rilo_fails(2, with("none.ply", {"--map-voxel", "0"}), {"--map-voxel"});
}

TEST(RunOutputs, AMapOfIntensitiesNeedsSome) {
  const TempDir folder;
  std::filesystem::create_directory(folder / "plain");
  replace(folder / "plain" / "0.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
          "end_header\n1 2 3\n");
  rilo_fails(3, {"run", folder / "plain", "--map", folder / "map.ply", "--map-intensity", "--quiet"},
             {"0.ply", "no intensities", "--map-intensity"});
}

}  // namespace
}  // namespace rilo::test
