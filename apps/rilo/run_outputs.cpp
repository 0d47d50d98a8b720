#include "run_outputs.hpp"

#include <sstream>
#include <system_error>

#include "rilo/config/config_file.hpp"
#include "rilo/io/atomic_file.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/map_writer.hpp"
#include "rilo/io/pose_writer.hpp"
#include "rilo/io/trajectory_recording.hpp"
#include "rilo/report/html_report.hpp"
#include "run_report.hpp"
#include "sweeps_csv.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

namespace fs = std::filesystem;

void write_poses(const fs::path& folder, const RunRecord& run) {
  Trajectory trajectory;
  for (const SweepResult& result : run.results) trajectory.push_back({result.stamp_ns, result.T_odom_lidar});
  write_kitti_poses(folder / "poses_lidar.txt", trajectory);
  write_tum(folder / "trajectory.tum", trajectory);
  write_euroc(folder / "trajectory.csv", trajectory);
  write_mcap(folder / "trajectory.mcap", run.results);
  if (can_write_bags()) {
    write_bag(folder / "trajectory.bag", run.results);
  }
  if (run.source.T_cam_lidar) {
    write_kitti_poses_camera(folder / "poses_camera.txt", trajectory, *run.source.T_cam_lidar);
  } else {
    fs::remove(folder / "poses_camera.txt");
  }
}

void write_report(const RunFlags& flags, const RunRecord& run, const nlohmann::json& metrics) {
  const fs::path file = fs::path(flags.out) / "report.html";
  if (flags.no_report || run.results.empty()) {
    fs::remove(file);
    return;
  }
  std::ostringstream html;
  write_html_report(report_of(run, metrics), html);
  write_atomically(file, html.str());
}

void write_folder(const RunFlags& flags, const RunRecord& run, const nlohmann::json& metrics) {
  const fs::path folder = flags.out;
  write_poses(folder, run);
  write_atomically(folder / "config.yaml", dump_config(run.config));
  write_atomically(folder / "sweeps.csv", sweeps_csv(run));
  write_atomically(folder / "metrics.json", json_text(metrics));
  write_report(flags, run, metrics);
}

}  // namespace

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::is_directory(folder)) return;
  const std::string reason = error ? error.message() : "it is not a folder";
  throw CommandError(kCannotWrite, folder.string() + ": cannot be created (" + reason + "); choose another --out");
}

void prepare_outputs(const RunFlags& flags) {
  if (!flags.map.empty() && !flags.map.ends_with(".ply") && !flags.map.ends_with(".pcd")) {
    throw CommandError(kUsage, "--map " + flags.map + ": expected a file that ends in .ply or .pcd");
  }
  try {
    if (!flags.out.empty()) {
      create_folder(flags.out);
      const AtomicFile probe(fs::path(flags.out) / "metrics.json");
    }
    if (!flags.map.empty()) {
      const MapWriter probe(flags.map);
    }
  } catch (const IoError& error) {
    throw CommandError(kCannotWrite, error.what());
  }
}

void write_outputs(const RunFlags& flags, const RunRecord& run, const nlohmann::json& metrics) {
  try {
    if (!flags.out.empty()) write_folder(flags, run, metrics);
    if (!flags.map.empty()) write_map(flags.map, run.map);
  } catch (const IoError& error) {
    throw CommandError(kCannotWrite, error.what());
  } catch (const fs::filesystem_error& error) {
    throw CommandError(kCannotWrite, error.what());
  }
}

}  // namespace rilo::cli
