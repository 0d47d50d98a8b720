#include "results/run_outputs.hpp"

#include <system_error>

#include <fmt/format.h>

#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "io/file_bytes.hpp"
#include "report/html_report.hpp"
#include "results/metrics_json.hpp"
#include "results/run_report.hpp"
#include "results/sweep_table.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/map_writer.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

// A frame of ROS 1 may begin with a slash, which TF2 takes for a mistake.
std::string without_slash(std::string frame) { return frame.erase(0, frame.find_first_not_of('/')); }

RecordingNames names_of(const OutputRequest& flags, const SourceInfo& source) {
  RecordingNames names;
  if (!flags.odom_frame.empty()) names.odom_frame = without_slash(flags.odom_frame);
  const std::string given = without_slash(flags.lidar_frame);
  const std::string frame = given.empty() ? without_slash(source.frame_id) : given;
  // Points that somebody has put into the odometry frame say nothing about the sensor's.
  if (!frame.empty() && (!given.empty() || frame != names.odom_frame)) names.lidar_frame = frame;
  return names;
}

void check_frames(const OutputRequest& flags) {
  const RecordingNames names = names_of(flags, {});
  if (names.odom_frame != names.lidar_frame) return;
  throw RunError(RunErrorKind::kUsage, "--odom-frame and --lidar-frame are both " + names.odom_frame +
                                           ": expected two frames, between which the trajectory is the transform");
}

void write_poses(const fs::path& folder, const RunRecord& run) {
  const Trajectory trajectory = run.trajectory();
  write_kitti_poses(folder / "poses_lidar.txt", trajectory);
  write_tum(folder / "trajectory.tum", trajectory);
  write_euroc(folder / "trajectory.csv", trajectory);
  if (run.source.T_cam_lidar) {
    write_kitti_poses_camera(folder / "poses_camera.txt", trajectory, *run.source.T_cam_lidar);
  } else {
    fs::remove(folder / "poses_camera.txt");
  }
}

// Only when there is something in it: what a run of no use has learnt is not kept.
void write_calibration(const fs::path& folder, const RunRecord& run) {
  const fs::path file = folder / "calibration.yaml";
  if (run.learnt.beams.empty()) {
    fs::remove(file);
    return;
  }
  const std::string source = fmt::format("{} of {}", counted(run.learnt_from, "sweep"), run.data.string());
  write_atomically(file, dump_calibration(run.learnt, source));
}

// After all else: these are written by libraries that have failures of their own.
void write_recordings(const fs::path& folder, const RunRecord& run, const RecordingNames& names) {
  write_mcap(folder / "trajectory.mcap", run.results, names);
  if (can_write_bags()) write_bag(folder / "trajectory.bag", run.results, names);
}

void write_report(const OutputRequest& flags, const RunRecord& run, const RunMetrics& metrics) {
  const fs::path file = fs::path(flags.out) / "report.html";
  if (flags.no_report || run.results.empty()) {
    fs::remove(file);
    return;
  }
  write_atomically(file, html_report({"", {}, {report_of(run, metrics)}, {}}));
}

// Of an earlier run into the same folder, unless it is the one that is written now.
void remove_stale_maps(const OutputRequest& flags) {
  for (const char* name : {"map.ply", "map.pcd"}) {
    const fs::path file = fs::path(flags.out) / name;
    std::error_code ignored;
    const bool written_now =
        !flags.map.empty() && fs::weakly_canonical(flags.map, ignored) == fs::weakly_canonical(file, ignored);
    if (!written_now) fs::remove(file);
  }
}

void write_folder(const OutputRequest& flags, const RunRecord& run, const RunMetrics& metrics) {
  const fs::path folder = flags.out;
  write_poses(folder, run);
  write_atomically(folder / "config.yaml", dump_config(run.config));
  write_calibration(folder, run);
  write_atomically(folder / "sweeps.csv", sweeps_csv(run.results, run.indices));
  write_atomically(folder / "metrics.json", json_text(to_json(metrics)));
  write_report(flags, run, metrics);
  remove_stale_maps(flags);
  write_recordings(folder, run, names_of(flags, run.source));
}

}  // namespace

void guard_writing(const std::function<void()>& write) {
  try {
    write();
  } catch (const IoError& error) {
    throw RunError(RunErrorKind::kCannotWrite, error.what());
  } catch (const fs::filesystem_error& error) {
    throw RunError(RunErrorKind::kCannotWrite, error.what());
  }
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (detail::is_folder(folder)) return;
  const std::string reason = error ? error.message() : "it is not a folder";
  throw RunError(RunErrorKind::kCannotWrite,
                 folder.string() + ": cannot be created (" + reason + "); choose another --out");
}

void prepare_outputs(const OutputRequest& flags) {
  check_frames(flags);
  if (!flags.map.empty() && !flags.map.ends_with(".ply") && !flags.map.ends_with(".pcd")) {
    throw RunError(RunErrorKind::kUsage, "--map " + flags.map + ": expected a file that ends in .ply or .pcd");
  }
  guard_writing([&] {
    if (!flags.out.empty()) {
      create_folder(flags.out);
      const AtomicFile probe(fs::path(flags.out) / "metrics.json");
    }
    if (!flags.map.empty()) const MapWriter probe(flags.map);
  });
}

void write_outputs(const OutputRequest& flags, const RunRecord& run, const RunMetrics& metrics) {
  guard_writing([&] {
    if (!flags.out.empty()) write_folder(flags, run, metrics);
    if (!flags.map.empty()) write_map(flags.map, run.map);
  });
}

}  // namespace rilo
