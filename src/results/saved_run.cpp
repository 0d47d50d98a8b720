#include "results/saved_run.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "io/folders/ground_truth.hpp"
#include "io/stamp_difference.hpp"
#include "io/times/sweep_period.hpp"
#include "results/metrics_json.hpp"
#include "results/partial_poses.hpp"
#include "results/sweep_table.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMetrics = "metrics.json";
constexpr const char* kAgain = "Run rilo run again";

void fill_record(const RunMetrics& metrics, RunRecord& run) {
  run.command_line = metrics.command;
  // A relative path is one from where the run was started.
  const bool relative = fs::path(metrics.data).is_relative();
  const bool there = relative && !metrics.data_path.empty() && detail::path_exists(metrics.data_path);
  run.data = there ? metrics.data_path : metrics.data;
  run.threads = metrics.threads;
  run.peak_rss_mb = metrics.peak_rss_mb.value_or(0);
  run.signal = metrics.interrupted ? 1 : 0;
  run.error = metrics.error;
  run.source.kind = metrics.format.substr(0, metrics.format.find(", "));
  run.source.format =
      metrics.format.size() > run.source.kind.size() ? metrics.format.substr(run.source.kind.size() + 2) : "";
  run.source.point_times = metrics.point_times;
  run.source.has_point_times = metrics.motion_compensation;
  run.source.elevation_correction_deg = metrics.elevation_correction_deg.value_or(0);
  run.source.topic = metrics.topic;
  run.source.parts = std::max<std::size_t>(1, metrics.parts);
  run.source.warnings = metrics.warnings;
  run.pose_instant = parse_pose_instant(metrics.pose_instant).value_or(run.pose_instant);
}

/// By the stamps; the default of a source when there is none.
double period_of(const RunRecord& run) {
  std::vector<std::int64_t> stamps;
  for (const SweepResult& result : run.results) stamps.push_back(result.stamp_ns);
  return detail::mean_period_s(stamps).value_or(run.source.period_s);
}

/// The configuration decides one line of the report; one of another version is not a reason to refuse the run.
OdometryConfig config_of(const fs::path& folder) {
  try {
    return detail::is_file(folder / "config.yaml") ? load_config(folder / "config.yaml") : OdometryConfig{};
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

/// What is beside the poses may be missing or damaged: the rest is shown all the same.
template <typename Read>
void read_beside(SavedRun& run, const char* what, const Read& read) {
  try {
    read();
  } catch (const IoError& error) {
    run.notices.push_back(fmt::format("{} cannot be read: {}", what, error.what()));
  }
}

void read_map(SavedRun& run) {
  const auto file = map_file(run.folder);
  if (!file) return;
  read_beside(run, file->filename().c_str(), [&] {
    run.record.map.points = (file->extension() == ".ply" ? read_ply(*file) : read_pcd(*file)).points;
  });
}

/// The files do not hold the velocity during a sweep: it is taken from the poses before and after it.
void add_twists(std::vector<SweepResult>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SweepResult& before = results[i == 0 ? 0 : i - 1];
    const SweepResult& after = results[std::min(i + 1, results.size() - 1)];
    const double dt_s = detail::seconds_between(before.stamp_ns, after.stamp_ns);
    if (dt_s > 0.0) results[i].twist = se3_log(before.T_odom_lidar.inverse() * after.T_odom_lidar) / dt_s;
  }
}

void set_poses(const fs::path& file, RunRecord& run) {
  const std::vector<SE3> poses = read_kitti_poses(file);
  if (poses.size() != run.results.size()) {
    throw IoError({file, "", counted(poses.size(), "pose"),
                   fmt::format("{}, as sweeps.csv has lines", run.results.size()),
                   "The files are of different runs. " + std::string(kAgain)});
  }
  for (std::size_t i = 0; i < poses.size(); ++i) run.results[i].T_odom_lidar = poses[i];
  add_twists(run.results);
}

SavedRun read_killed_run(const fs::path& folder) {
  SavedRun run;
  run.folder = folder;
  run.killed = true;
  PosesSoFar so_far = read_partial_poses(folder / kPartialPoses);
  run.record.indices = std::move(so_far.sweeps);
  for (const SE3& T : so_far.poses) {
    SweepResult result;
    result.T_odom_lidar = T;
    run.record.results.push_back(result);
  }
  run.notices.push_back(fmt::format("this run was killed or is still running: only {} is there, with its first {}",
                                    kPartialPoses, counted(run.record.results.size(), "pose")));
  return run;
}

}  // namespace

RunMetrics read_metrics(const fs::path& file) {
  RunMetrics metrics = metrics_of(read_json_object(file, "metrics.json of rilo run", kAgain), file);
  for (std::string* text : {&metrics.rilo_version, &metrics.point_times}) {
    if (text->empty()) *text = "unknown";
  }
  return metrics;
}

bool is_saved_run(const fs::path& folder) {
  return detail::is_file(folder / kMetrics) || detail::is_file(folder / kPartialPoses);
}

SavedRun read_saved_run(const fs::path& folder) {
  if (!detail::is_folder(folder)) {
    throw IoError({folder, "", detail::path_exists(folder) ? "a file" : "no such folder",
                   "a folder that rilo run --out has written", "Check the path"});
  }
  if (!is_saved_run(folder)) {
    throw IoError({folder, "", "neither metrics.json nor poses_lidar.partial.txt in it",
                   "a folder that rilo run --out has written", "Check the path"});
  }
  if (!detail::is_file(folder / kMetrics)) return read_killed_run(folder);
  SavedRun run;
  run.folder = folder;
  run.metrics = read_metrics(folder / kMetrics);
  fill_record(run.metrics, run.record);
  SweepTable sweeps = read_sweeps_csv(folder / "sweeps.csv");
  run.record.results = std::move(sweeps.results);
  run.record.indices = std::move(sweeps.indices);
  set_poses(folder / "poses_lidar.txt", run.record);
  run.record.source.period_s = period_of(run.record);
  run.record.config = config_of(folder);
  if (detail::is_file(run.record.data / "calib.txt")) {
    read_beside(run, "calib.txt",
                [&] { run.record.source.T_cam_lidar = read_kitti_calibration(run.record.data / "calib.txt"); });
  }
  read_map(run);
  if (detail::is_file(folder / kPartialPoses)) {
    run.notices.push_back(fmt::format(
        "a later run into this folder was killed or is still running ({}); shown is the one before", kPartialPoses));
  }
  return run;
}

}  // namespace rilo
