// rilo run: odometry over recorded sweeps.
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/map_writer.hpp"
#include "rilo/odometry/odometry.hpp"
#include "run_record.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

namespace {

constexpr double kMapVoxelM = 0.2;
constexpr double kPictureVoxelM = 0.75;  // enough for the report's picture of the map

struct RunFlags {
  std::string data;
  std::string config_file;
  std::vector<std::string> settings;
  std::string out;
  std::string map;
  std::size_t start = 0;
  std::size_t count = 0;
  int threads = -1;
  bool quiet = false;
  bool json = false;
  bool no_report = false;
  SourceOptions source;
};

constexpr const char* kFooter =
    R"(DATA is a KITTI sequence folder, a drive simulator's folder, a folder of .bin, .pcd or .ply sweeps, or one such file.

Examples:
  rilo run kitti/sequences/00 --out results/00 --elevation-correction 0.205
  rilo run 2011_09_26_drive_0001_sync --point-times azimuth --out results/0001
  rilo run sweeps/ --bin-fields x,y,z,intensity,ring --set preprocess.max_range_m=60 --map map.pcd

Leaves in --out: poses_lidar.txt, poses_camera.txt (with a calibration), trajectory.tum, config.yaml, sweeps.csv, metrics.json,
report.html. Ctrl-C ends the run after the current sweep and writes what there is.)";

OdometryConfig configuration(const RunFlags& flags) {
  const OdometryConfig from_file = flags.config_file.empty() ? OdometryConfig{} : load_config(flags.config_file);
  OdometryConfig config = with_overrides(from_file, flags.settings);
  if (flags.threads >= 0) {
    config.threads = flags.threads;
  }
  validate(config);
  return config;
}

/// Poses as they come, so that even a killed run leaves a valid prefix. Removed when the whole file is written.
class PartialPoses {
 public:
  explicit PartialPoses(const std::filesystem::path& folder) {
    if (!folder.empty()) {
      file_ = folder / "poses_lidar.partial.txt";
      stream_.open(file_);
    }
  }
  ~PartialPoses() {
    if (!file_.empty()) {
      stream_.close();
      std::error_code ignored;
      std::filesystem::remove(file_, ignored);
    }
  }
  PartialPoses(const PartialPoses&) = delete;
  PartialPoses& operator=(const PartialPoses&) = delete;

  void add(const SE3& T) {
    if (file_.empty()) {
      return;
    }
    std::string line;
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) {
        line += fmt::format("{}{:.12g}", line.empty() ? "" : " ", T(row, column));
      }
    }
    stream_ << line << '\n' << std::flush;
  }

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
};

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

bool has_pose_of_its_own(OdometryStatus status) {
  return status != OdometryStatus::kLost && status != OdometryStatus::kEmpty;
}

/// Runs the odometry until the data, the count or the user ends it. An error in the data ends it too and is kept.
void run_sweeps(const RunFlags& flags, ScanSource& source, RunRecord& run) {
  Odometry odometry(run.config, steady_ns);
  ThinnedMap map(flags.map.empty() ? kPictureVoxelM : kMapVoxelM);
  PartialPoses partial(flags.out);
  source.skip(flags.start);
  std::optional<std::size_t> total = source.size();
  if (total) {
    *total -= std::min(*total, flags.start);
  }
  if (flags.count > 0) {
    total = total ? std::min(*total, flags.count) : flags.count;
  }
  Progress progress("rilo", total, flags.quiet);
  const InterruptGuard guard;
  const auto begin = std::chrono::steady_clock::now();
  while ((flags.count == 0 || run.results.size() < flags.count) && InterruptGuard::signal() == 0) {
    std::optional<Sweep> sweep;
    try {
      sweep = source.next();
    } catch (const IoError& error) {
      run.error = error.what();
      break;
    }
    if (!sweep) {
      break;
    }
    const SweepResult result = odometry.register_sweep(*sweep);
    run.results.push_back(result);
    run.indices.push_back(source.current_index());
    partial.add(result.T_odom_lidar);
    if (has_pose_of_its_own(result.status)) {
      map.add(odometry.last_map_points(), result.T_odom_lidar);
    }
    progress.update(run.results.size(),
                    result.status == OdometryStatus::kOk ? "" : std::string(to_string(result.status)));
  }
  progress.finish();
  run.signal = InterruptGuard::signal();
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.source = source.info();
  run.map = map.points();
}

void write_map_file(const RunFlags& flags, const RunRecord& run) {
  try {
    write_map(flags.map, run.map);
  } catch (const IoError& error) {
    throw CommandError(kCannotWrite, error.what());
  }
}

int run_command(const RunFlags& flags, const std::string& command_line) {
  RunRecord run;
  run.command_line = command_line;
  run.data = flags.data;
  run.config = configuration(flags);
  run.threads = run.config.threads > 0 ? run.config.threads : static_cast<int>(std::thread::hardware_concurrency());
  if (!flags.map.empty() && !flags.map.ends_with(".ply") && !flags.map.ends_with(".pcd")) {
    throw CommandError(kUsage, "--map " + flags.map + ": expected a file that ends in .ply or .pcd");
  }
  const auto source = open_scan_source(flags.data, flags.source);
  if (!flags.out.empty()) {
    prepare_output(flags.out);
  }
  run_sweeps(flags, *source, run);
  if (run.results.empty() && run.error.empty() && run.signal == 0) {
    throw CommandError(kBadData, flags.data + ": no sweep left to run; --start is " + std::to_string(flags.start));
  }
  evaluate_run(run);
  const nlohmann::json metrics = run_metrics(run);
  if (!flags.out.empty()) {
    write_outputs(run, metrics, flags.out, !flags.no_report);
  }
  if (!flags.map.empty()) {
    write_map_file(flags, run);
  }
  if (flags.json) {
    std::cout << metrics.dump(2) << '\n';
  } else if (!flags.quiet) {
    std::cout << run_summary(metrics);
  }
  if (!run.error.empty()) {
    throw CommandError(kBadData, run.error + " (" + std::to_string(run.results.size()) + " sweeps before it are kept)");
  }
  return run.signal == 0 ? kSuccess : 128 + run.signal;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = app.add_subcommand("run", "odometry over recorded sweeps");
  command->footer(kFooter);
  command->add_option("DATA", flags->data, "folder or file with sweeps")->required();
  command->add_option("--config", flags->config_file, "YAML configuration; see rilo config --dump");
  command->add_option("--set", flags->settings, "key=value, repeatable; overrides the file")->allow_extra_args(false);
  command->add_option("--out", flags->out, "folder for the results (created)");
  command->add_option("--map", flags->map, "map of the whole run, .ply or .pcd");
  command->add_option("--start", flags->start, "leave out that many sweeps")->capture_default_str();
  command->add_option("--count", flags->count, "run that many sweeps; 0: all")->capture_default_str();
  command
      ->add_option("--threads", flags->threads, "threads; 0: as many as the machine has. Results do not depend on it")
      ->check(CLI::Range(0, 1024));
  command->add_flag("--quiet", flags->quiet, "no progress and no summary");
  command->add_flag("--json", flags->json, "print metrics.json instead of the summary");
  command->add_flag("--no-report", flags->no_report, "do not write report.html");
  add_source_flags(*command, flags->source);
  command->callback(
      [flags, &exit_code, &app] { exit_code = run_command(*flags, app.get_name() + " run " + flags->data); });
}

}  // namespace rilo::cli
