#include "saved_run.hpp"

#include <algorithm>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "json_file.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_reader.hpp"
#include "saved_sweeps.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kMetrics = "metrics.json";
constexpr const char* kPartial = "poses_lidar.partial.txt";
constexpr const char* kAgain = "Run rilo run again";

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// What a report reads from metrics.json; each with a value of the type that it must have.
Json needed_metrics() {
  return {{"rilo_version", "unknown"},
          {"command", ""},
          {"data", ""},
          {"format", ""},
          {"interrupted", false},
          {"ms_note", ""},
          {"peak_rss_mb", 0.0},
          {"threads", 0},
          {"pose_instant", "mid"},
          {"point_times", "unknown"},
          {"error", ""},
          {"motion_compensation", false},
          {"warnings", Json::array()},
          {"truth_error", ""},
          {"elevation_correction_deg", 0.0},
          {"beam_elevation_rms_deg", 0.0},
          {"beam_azimuth_rms_deg", 0.0},
          {"elevation_offset_applied_deg", 0.0}};
}

Json read_metrics(const fs::path& file) {
  Json metrics = read_json_object(file, "metrics.json of rilo run", kAgain);
  const auto needed = needed_metrics();
  for (const auto& [key, fallback] : needed.items()) {
    const bool there = metrics.contains(key);
    const bool fits =
        there && (metrics[key].is_number() ? fallback.is_number() : metrics[key].type() == fallback.type());
    if (there && !fits) {
      throw IoError({file, "key " + key, metrics[key].type_name(), fallback.type_name(), kAgain});
    }
    if (!there) metrics[key] = fallback;
  }
  for (const char* key : {"elevation_offset_deg", "elevation_offset_sigma_deg"}) {  // both or none
    if (!metrics.contains(key) || !metrics[key].is_number()) metrics["elevation_offset_deg"] = nullptr;
  }
  return metrics;
}

void fill_record(const Json& metrics, RunRecord& run) {
  run.command_line = metrics["command"];
  run.data = metrics["data"].get<std::string>();
  run.threads = metrics["threads"];
  run.peak_rss_mb = metrics["peak_rss_mb"];
  run.signal = metrics["interrupted"].get<bool>() ? 1 : 0;
  run.error = metrics["error"];
  const std::string format = metrics["format"];
  run.source.kind = format.substr(0, format.find(", "));
  run.source.format = format.size() > run.source.kind.size() ? format.substr(run.source.kind.size() + 2) : "";
  run.source.point_times = metrics["point_times"];
  run.source.has_point_times = metrics["motion_compensation"];
  run.source.elevation_correction_deg = metrics["elevation_correction_deg"];
  for (const Json& warning : metrics["warnings"]) {
    if (warning.is_string()) run.source.warnings.push_back(warning);
  }
  for (const PoseInstant instant : {PoseInstant::kStart, PoseInstant::kMid, PoseInstant::kEnd}) {
    if (metrics["pose_instant"] == to_string(instant)) run.pose_instant = instant;
  }
}

/// Median step of the stamps; the default of a source when there is none.
double period_of(const RunRecord& run) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < run.results.size(); ++i) {
    steps.push_back(run.results[i].stamp_ns - run.results[i - 1].stamp_ns);
  }
  if (steps.empty()) return run.source.period_s;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle > 0 ? static_cast<double>(*middle) * 1e-9 : run.source.period_s;
}

/// The configuration decides one line of the report; one of another version is no reason to refuse the run.
OdometryConfig config_of(const fs::path& folder) {
  try {
    return is_file(folder / "config.yaml") ? load_config(folder / "config.yaml") : OdometryConfig{};
  } catch (const ConfigError&) {
    return {};
  }
}

/// map.ply or map.pcd, else the only such file.
std::optional<fs::path> map_file(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    if (!entry.is_regular_file() || (file.extension() != ".ply" && file.extension() != ".pcd")) continue;
    if (file.stem() == "map") return file;
    found.push_back(file);
  }
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

void read_map(SavedRun& run) {
  const auto file = map_file(run.folder);
  if (file) run.record.map.points = (file->extension() == ".ply" ? read_ply(*file) : read_pcd(*file)).points;
}

void set_poses(const fs::path& file, RunRecord& run) {
  const std::vector<SE3> poses = read_kitti_poses(file);
  if (poses.size() != run.results.size()) {
    throw IoError({file, "", counted(poses.size(), "pose"),
                   fmt::format("{}, as sweeps.csv has lines", run.results.size()),
                   "The files are of different runs. " + std::string(kAgain)});
  }
  for (std::size_t i = 0; i < poses.size(); ++i) run.results[i].T_odom_lidar = poses[i];
}

SavedRun read_killed_run(const fs::path& folder) {
  SavedRun run;
  run.folder = folder;
  run.killed = true;
  run.metrics = needed_metrics();
  run.metrics["elevation_offset_deg"] = nullptr;
  for (const SE3& T : read_growing_kitti_poses(folder / kPartial)) {
    SweepResult result;
    result.T_odom_lidar = T;
    run.record.indices.push_back(run.record.results.size());
    run.record.results.push_back(result);
  }
  run.notices.push_back(fmt::format("this run was killed or is still going on: only {} is there, with its first {}",
                                    kPartial, counted(run.record.results.size(), "pose")));
  return run;
}

}  // namespace

bool is_saved_run(const fs::path& folder) { return is_file(folder / kMetrics) || is_file(folder / kPartial); }

SavedRun read_saved_run(const fs::path& folder) {
  if (!is_file(folder / kMetrics)) return read_killed_run(folder);
  SavedRun run;
  run.folder = folder;
  run.metrics = read_metrics(folder / kMetrics);
  fill_record(run.metrics, run.record);
  SavedSweeps sweeps = read_sweeps_csv(folder / "sweeps.csv");
  run.record.results = std::move(sweeps.results);
  run.record.indices = std::move(sweeps.indices);
  set_poses(folder / "poses_lidar.txt", run.record);
  run.record.source.period_s = period_of(run.record);
  run.record.config = config_of(folder);
  if (is_file(run.record.data / "calib.txt")) {
    run.record.source.T_cam_lidar = read_kitti_calibration(run.record.data / "calib.txt");
  }
  read_map(run);
  if (is_file(folder / kPartial)) {
    run.notices.push_back(fmt::format(
        "a later run into this folder was killed or is still going on ({}); shown is the one before", kPartial));
  }
  return run;
}

}  // namespace rilo::cli
