// rilo run: odometry over recorded sweeps.
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "checks.hpp"
#include "command.hpp"
#include "console/folder_lock.hpp"
#include "console/interrupt.hpp"
#include "console/text.hpp"
#include "io/text.hpp"
#include "results/metrics_json.hpp"
#include "results/output_check.hpp"
#include "results/run_metrics.hpp"
#include "results/run_observers.hpp"
#include "results/run_outputs.hpp"
#include "results/run_record.hpp"
#include "results/unusable_sweeps.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/session/session_observer.hpp"
#include "session/processors.hpp"
#include "source_flags.hpp"
#include "view_flags.hpp"

namespace rilo::cli {

namespace {

constexpr double kShareOfIdleProcessor = 0.5;

struct RunFlags : RunRequest, OutputRequest {
  std::string config_file;
  std::vector<std::string> settings;
  int threads = -1;  // -1: as configured
  bool json = false;
  bool no_truth = false;
  bool real_time = false;  // no faster than recorded
  std::string view;        // --view: its port or "auto"; empty: no viewer
  ViewOptions view_options;
};

constexpr const char* kRunFooter =
    R"(DATA is a recording (ROS 1 bags, rosbag2, MCAP), a pcap of a Velodyne or an Ouster, a KITTI sequence or raw drive, a
MulRan sequence, a drive simulator's folder, a folder of .bin, .pcd or .ply sweeps, or one such file.

Examples:
  rilo run kitti/sequences/00 --out results/00 --elevation-correction 0.205
  rilo run drive.bag --topic /velodyne_points --out results/drive
  rilo run 2011_09_26_drive_0001_sync --point-times azimuth --out results/0001
  rilo run other.bag --one-pass --calibration results/drive/calibration.yaml
  rilo run kitti/sequences/00 --view
  rilo run sweeps/ --bin-fields x,y,z,intensity,ring --set preprocess.max_range_m=60 --map map.pcd

Leaves in --out: poses_lidar.txt, poses_camera.txt (where DATA has Tr or KITTI raw's calibration), trajectory.tum, .csv
(EuRoC), .mcap (Foxglove, ROS 2) and, in builds with ROS' library, .bag (ROS 1), config.yaml (loadable),
calibration.yaml (what was learnt about the sensor), sweeps.csv (one line of statistics per sweep), metrics.json,
report.html. Where ground truth lies in DATA, errors are in metrics.json and the report. While running,
poses_lidar.partial.txt grows by one line per sweep.
Ctrl-C, SIGTERM or a closed terminal ends the run after the current sweep and writes what there is (exit code 130, 143,
129); a second one ends it at once.)";

OdometryConfig configuration(const RunFlags& flags) {
  OdometryConfig config = load_config(flags.config_file, flags.settings);
  if (flags.threads >= 0) config.threads = flags.threads;
  return config;
}

int finish(const RunFlags& flags, const RunRecord& run, PartialPoses& partial) {
  const RunMetrics metrics = run_metrics(run);
  write_outputs(flags, run, metrics);
  partial.remove();
  if (flags.json) {
    std::cout << json_text(to_json(metrics));
  } else if (!flags.quiet) {
    std::cout << run_summary(metrics);
    if (!flags.out.empty()) std::cout << "results         " << flags.out << '\n';
    if (!flags.map.empty()) std::cout << "map             " << flags.map << '\n';
  }
  if (!run.error.empty()) {
    throw RunError(kind_of(run.error_code),
                   fmt::format("{} (kept: {} before it)", run.error, counted(run.results.size(), "sweep")));
  }
  return run.signal == 0 ? kSuccess : kSignalBase + run.signal;
}

std::unique_ptr<LiveView> open_view(const RunFlags& flags, const ScanSource& source, const OdometryConfig& config) {
  if (flags.view.empty()) return nullptr;
  ViewOptions options = flags.view_options;
  if (flags.view != "auto") {
    const auto port = detail::parse_unsigned(flags.view);
    if (!port || *port > 65535) {
      throw RunError(RunErrorKind::kUsage, "--view=" + flags.view + ": expected a port, 0 … 65535");
    }
    options.port = static_cast<std::uint16_t>(*port);
  }
  // A processor that the odometry leaves alone may be used: half of it, there is reading and the system as well.
  if (config.threads > 0 && config.threads < usable_processors()) options.share = kShareOfIdleProcessor;
  ViewInfo info = view_info(flags.data, config);
  info.sweeps = sweeps_to_do(source, flags.start, flags.count);
  return std::make_unique<LiveView>(info, options,
                                    flags.no_truth ? std::nullopt : std::optional(TruthTrack(flags.data)));
}

/// Results of nothing but guesses are no success; where some sweeps could be used, the rest is worth a warning.
void judge(const RunFlags& flags, const UnusableSweeps& unusable, RunRecord& run) {
  const std::string warning = unusable.warning();
  if (warning.empty()) return;
  if (unusable.all() && run.error.empty() && run.signal == 0) {
    run.error = flags.data + ": " + warning;
    run.error_code = kBadData;
    return;
  }
  run.source.warnings.push_back(warning);
  if (!flags.quiet) std::cerr << "rilo: warning: " << warning << '\n';
}

/// The session ends here: what it holds, its map above all, makes room for the writing of the results.
void observe_and_run(const RunFlags& flags, std::unique_ptr<Session> session, PartialPoses& partial, LiveView* view,
                     RunRecord& run) {
  SweepCheck check(flags);
  ProgressLine progress(flags, session->source());
  MapObserver map(flags.map_voxel_m);
  MapPicture picture;
  std::optional<ViewFeed> feed;
  Pace pace;
  UnusableSweeps unusable(run.config.preprocess);
  const bool picture_wanted = flags.map.empty() && !flags.out.empty() && !flags.no_report;
  session->add(check);
  if (flags.real_time) session->add(pace);
  session->add(partial);
  if (!flags.map.empty()) session->add(map);  // for the file; the report draws it, too
  if (picture_wanted) session->add(picture);
  session->add(unusable);
  session->add(progress);
  if (view != nullptr) session->add(feed.emplace(*view));
  take(session->run(), run);
  judge(flags, unusable, run);
  if (!flags.map.empty()) run.map = map.cloud(flags.map_normals);
  if (picture_wanted) run.map.points = picture.points();
}

/// A recording is read faster than the viewer takes its points: those that it missed.
void show_the_rest(const RunFlags& flags, const RunRecord& run, LiveView& view) {
  if (!flags.quiet) std::cerr << "rilo: done; the viewer stays at " << view.viewer().url() << " until Ctrl-C\n";
  try {
    RunFlags same = flags;
    if (run.trial.raw()) same.source.options.point_times = run.trial.times;  // as the run has read them
    const auto source = source_of(same)();
    source->skip(flags.start);
    view.show_missing(*source, run);
  } catch (const IoError& error) {
    std::cerr << "rilo: warning: " << error.what() << '\n';
  }
  view.viewer().finish();
  InterruptGuard::wait();
}

/// A map without a folder belongs to the other results; without a map nothing needs its intensities.
RunFlags completed(RunFlags flags) {
  flags.one_pass = flags.one_pass || flags.real_time;  // nobody wants to wait for the same sweeps twice
  flags.map_intensity = flags.map_intensity && !flags.map.empty();
  const std::filesystem::path map = flags.map;
  if (!flags.out.empty() && !map.empty() && !map.has_parent_path()) flags.map = std::filesystem::path(flags.out) / map;
  return flags;
}

int run_command(const RunFlags& flags, const std::string& command_line) {
  RunRecord run;
  run.command_line = command_line;
  run.data = flags.data;
  run.calibration = flags.calibration;
  run.config = configuration(flags);
  auto session = std::make_unique<Session>(source_of(flags), session_options(flags, run.config));
  check_outputs(flags, flags, flags.config_file);
  prepare_outputs(flags);
  if (flags.out.empty() && !flags.quiet) std::cerr << "rilo: note: results are not kept; --out FOLDER keeps them\n";
  if (!flags.calibration.empty() && run.config.elevation.initial_deg != 0.0 && !flags.quiet) {
    std::cerr << "rilo: warning: elevation.initial_deg is ignored: the --calibration says what to begin with\n";
  }
  const FolderLock lock(flags.out);
  const InterruptGuard guard;
  const auto view = open_view(flags, session->source(), run.config);
  PartialPoses partial(flags.out);
  observe_and_run(flags, std::move(session), partial, view.get(), run);
  if (run.results.empty() && run.signal == 0) {
    partial.remove();
    throw RunError(kind_of(run.error_code), run.error);
  }
  if (!flags.no_truth) {
    const std::size_t told = run.source.warnings.size();
    evaluate_run(run);
    for (std::size_t i = told; i < run.source.warnings.size() && !flags.quiet; ++i) {
      std::cerr << "rilo: warning: " << run.source.warnings[i] << '\n';
    }
  }
  const int exit_code = finish(flags, run, partial);
  if (view && run.signal == 0) show_the_rest(flags, run, *view);
  return exit_code;
}

/// Options that are given without the one that they belong to.
void warn_of_idle_options(const CLI::App& command) {
  constexpr std::array<std::pair<const char*, const char*>, 6> kNeeds = {{{"--map-voxel", "--map"},
                                                                          {"--map-normals", "--map"},
                                                                          {"--map-intensity", "--map"},
                                                                          {"--odom-frame", "--out"},
                                                                          {"--lidar-frame", "--out"},
                                                                          {"--view-address", "--view"}}};
  for (const auto& [option, needed] : kNeeds) {
    if (command.count(option) == 0 || command.count(needed) > 0) continue;
    std::cerr << "rilo: warning: " << option << " is ignored: it is of no use without " << needed << '\n';
  }
}

void add_flags(CLI::App& command, RunFlags& flags) {
  command.add_option("DATA", flags.data, "folder or file with sweeps")->required()->check(path_given());
  command.add_option("--config", flags.config_file, "YAML configuration; rilo config --dump prints one")
      ->check(path_given());
  command.add_option("--set", flags.settings, "key=value, repeatable; overrides the file")->allow_extra_args(false);
  command
      .add_option("--calibration", flags.calibration,
                  "calibration.yaml of another run with this sensor: its angles from the first sweep on")
      ->check(path_given());
  command.add_option("--out", flags.out, "folder for the results (created)")->check(path_given());
  command
      .add_option("--map", flags.map,
                  "write the accumulated map (.ply or .pcd), one point per voxel; a bare name goes into --out")
      ->check(path_given());
  add_number(command, "--map-voxel", flags.map_voxel_m, ThinnedMap::kLeastVoxelM, ThinnedMap::kMostVoxelM,
             "edge of the map's voxels, m");
  command.add_flag("--map-normals", flags.map_normals, "normals in the map, towards where the surface was seen from");
  command.add_flag("--map-intensity", flags.map_intensity, "intensities in the map");
  command.add_option("--odom-frame", flags.odom_frame, "odometry frame in trajectory.mcap and trajectory.bag")
      ->default_str("odom")
      ->check(frame_given());
  command.add_option("--lidar-frame", flags.lidar_frame, "sensor frame in trajectory.mcap and trajectory.bag")
      ->default_str("the data's frame_id, else lidar")
      ->check(frame_given());
  add_count(command, "--start", flags.start, kAnyCount, "skip that many sweeps");
  add_count(command, "--count", flags.count, kAnyCount, "run that many sweeps; 0: all");
  command
      .add_option("--threads", flags.threads,
                  "threads; 0: as many as the machine has; the results do not depend on it. Default: as configured")
      ->check(whole_number(1024));
  command.add_flag("--one-pass", flags.one_pass,
                   "single pass as in live operation: no restart with what the first 200 sweeps say about the sensor");
  command.add_flag("--real-time", flags.real_time, "no faster than the sweeps were recorded, in one pass");
  command.add_flag("--quiet", flags.quiet, "no progress, no warnings, no summary");
  command.add_flag("--json", flags.json, "print metrics.json instead of the summary");
  command.add_flag("--no-report", flags.no_report, "do not write report.html");
  command.add_flag("--no-truth", flags.no_truth, "do not look for ground truth");
  command.add_flag("--view{auto}", flags.view,
                   "serve a web page that shows the run; --view=PORT chooses the port (0: any free one). Stays until "
                   "Ctrl-C");
  add_address_flag(command, "--view-address", flags.view_options);
  add_source_flags(command, flags.source);
}

}  // namespace

void add_run_command(CLI::App& app, const std::string& command_line, int& exit_code) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = app.add_subcommand("run", "odometry over recorded sweeps");
  command->footer(kRunFooter);
  add_flags(*command, *flags);
  command->callback([command, flags, command_line, &exit_code] {
    if (!flags->quiet) warn_of_idle_options(*command);
    exit_code = run_command(completed(*flags), command_line);
  });
}

}  // namespace rilo::cli
