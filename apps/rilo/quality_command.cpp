// rilo quality: how sharp the map of a trajectory is; needs no ground truth.
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "checks.hpp"
#include "command.hpp"
#include "console/progress.hpp"
#include "console/text.hpp"
#include "results/saved_run.hpp"
#include "results/sweep_poses.hpp"
#include "rilo/evaluation/map_quality.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/session/session.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

namespace fs = std::filesystem;

namespace {

constexpr double kMillimetres = 1e3;

struct QualityFlags {
  std::string data;
  std::string poses;
  std::size_t start = 0;
  std::size_t count = 0;  // 0: all
  PairingOptions pairing;
  MapQualityConfig config;
  bool quiet = false;
  bool json = false;
  SourceRequest source;
};

struct QualityRun {
  MapQuality quality;
  std::string protocol;
  SourceInfo source;
};

constexpr const char* kQualityFooter =
    R"(DATA as for rilo run, read with the same options. POSES: of the LiDAR, KITTI form (12 numbers a line), TUM form
(t x y z qx qy qz qw) or EuRoC form (ns,x,y,z,qw,qx,qy,qz), detected from the first line; at the middle of the sweep,
as rilo's are. Sweeps with per-point times are motion-compensated with the velocity between the neighbouring poses
(--point-times none: they are already). Smaller is sharper. Compare trajectories on the same sweeps with the same
options; below about 1 % it is noise. Wrong poses lose planes, the thick ones first: distances to the planes compare at
about equal shares of planar places only, the mean over all places does not gain by a lost one. A path that is too short
draws sweeps together: where many more places have enough neighbours, that is no merit.

Examples:
  rilo quality kitti/sequences/00 results/00/poses_lidar.txt
  rilo quality drive results/trajectory.tum --max-range 60 --json)";

/// Which sweeps have a pose is not known where there are fewer or more of them.
std::optional<std::string> doubtful_pairs(const SweepPoses& poses, const std::optional<std::size_t>& sweeps) {
  if (poses.by_stamp() || !sweeps || *sweeps == poses.size()) return std::nullopt;
  return fmt::format(
      "{} for {}, paired one after the other, which is wrong where the poses begin later (--start tells where) or lack "
      "a sweep (poses with stamps, as in trajectory.tum, tell which)",
      counted(poses.size(), "pose"), counted(*sweeps, "sweep"));
}

/// The run that the poses are of had other times of the points. They are not taken: figures of several programs compare
/// where the sweeps are read alike.
std::optional<std::string> other_times(const QualityFlags& flags, const SourceInfo& source) {
  const auto kind = [](const std::string& times) { return times.substr(0, times.find(',')); };
  try {
    const fs::path folder = fs::path(flags.poses).parent_path();
    if (!is_saved_run(folder)) return std::nullopt;
    const std::string of_run = read_metrics(folder / "metrics.json").point_times;
    if (kind(of_run) == kind(source.point_times)) return std::nullopt;
    return fmt::format("the run had point times \"{}\", here they are \"{}\": see --point-times", of_run,
                       source.point_times);
  } catch (const IoError&) {
    return std::nullopt;  // of another program
  }
}

QualityRun measure(const QualityFlags& flags) {
  const SweepPoses poses(read_poses(flags.poses), flags.pairing);
  MapQualityMeter meter(flags.config);
  const auto source = open_scan_source(flags.data, flags.source.options);
  source->skip(flags.start);
  const std::optional<std::size_t> sweeps = sweeps_to_do(*source, flags.start, flags.count);
  Progress progress("rilo", sweeps, flags.quiet);
  const auto read = [&](std::size_t index) -> std::optional<Sweep> {
    if ((flags.count > 0 && index >= flags.count) || poses.end(index)) return std::nullopt;
    std::optional<Sweep> sweep = source->next();
    if (sweep) check_point_times(flags.source, *sweep, source->current_name());
    return sweep;
  };
  SweepWithNeighbours at;
  for (std::optional<Sweep> sweep = read(0); sweep;) {
    std::optional<Sweep> after = read(at.index + 1);
    at.middle_ns = middle_ns(*sweep);
    at.after_ns = after ? std::optional(middle_ns(*after)) : std::nullopt;
    if (const auto pose = poses.of(at, source->info().period_s)) meter.add(points_at(*sweep, *pose), pose->T);
    at.before_ns = at.middle_ns;
    sweep = std::move(after);
    progress.update(++at.index);
  }
  progress.finish();
  QualityRun run{meter.result(), "", source->info()};
  run.protocol = fmt::format("{}; {}, for {} of {}", poses.protocol(), counted(poses.size(), "pose"),
                             run.quality.sweeps, counted(sweeps.value_or(at.index), "sweep"));
  const auto doubt = doubtful_pairs(poses, sweeps_to_do(*source, flags.start, 0));
  if (doubt) run.source.warnings.push_back(flags.poses + ": " + *doubt);
  if (const auto times = other_times(flags, run.source)) run.source.warnings.push_back(flags.poses + ": " + *times);
  return run;
}

void check_found(const QualityFlags& flags, const QualityRun& run) {
  if (run.quality.sweeps == 0) {
    throw RunError(
        RunErrorKind::kBadData,
        fmt::format("{} and {}: no sweep has a pose ({}). Check that both use the same clock; otherwise take "
                    "--associate index, or a larger --max-gap-s",
                    flags.data, flags.poses, run.protocol));
  }
  if (run.quality.windows == 0) {
    throw RunError(RunErrorKind::kBadData,
                   fmt::format("{} and {}: {} ({}); expected at least one window of {}. Give more sweeps or a smaller "
                               "--window",
                               flags.data, flags.poses, counted(run.quality.sweeps, "sweep"), run.protocol,
                               flags.config.window_sweeps));
  }
  if (run.quality.plane_rms_m.count == 0) {
    throw RunError(RunErrorKind::kBadData,
                   fmt::format("{} and {}: no planar place among {} in {}; expected neighbours of at least {} "
                               "sweeps around a point. Check that the poses are of the LiDAR frame, or give a "
                               "larger --radius or --max-range",
                               flags.data, flags.poses, counted(run.quality.places, "place"),
                               counted(run.quality.windows, "window"), flags.config.min_sweeps));
  }
}

nlohmann::json quality_json(const QualityFlags& flags, const QualityRun& run) {
  const MapQuality& q = run.quality;
  const MapQualityConfig& c = flags.config;
  return {{"data", valid_utf8(flags.data)},
          {"poses", valid_utf8(flags.poses)},
          {"protocol", run.protocol},
          {"point_times", run.source.point_times},
          {"motion_compensation", run.source.has_point_times},
          {"elevation_correction_deg", run.source.elevation_correction_deg},
          {"bad_sweeps", run.source.bad_sweeps},
          {"warnings", run.source.warnings},
          {"sweeps", q.sweeps},
          {"windows", q.windows},
          {"samples", q.samples},
          {"places", q.places},
          {"planar_places", q.plane_rms_m.count},
          {"planar_share", q.planar_share},
          {"bounded_rms_m", q.bounded_rms_m},
          {"no_plane_m", no_plane_m(c)},
          {"plane_rms_m", {{"median", q.plane_rms_m.median}, {"mean", q.plane_rms_m.mean}, {"p75", q.plane_rms_p75_m}}},
          {"mean_map_entropy", q.mean_map_entropy.value_or(0)},
          {"window_sweeps", c.window_sweeps},
          {"sweep_step", c.sweep_step},
          {"min_range_m", c.min_range_m},
          {"max_range_m", c.max_range_m},
          {"voxel_m", c.voxel_m},
          {"points_per_sweep", c.points_per_sweep},
          {"samples_per_window", c.samples_per_window},
          {"radius_m", c.radius_m},
          {"seed", c.seed}};
}

std::string quality_table(const QualityFlags& flags, const QualityRun& run) {
  const MapQuality& q = run.quality;
  std::string text = fmt::format("{} with {}\n{}\n", valid_utf8(flags.data), valid_utf8(flags.poses), run.protocol);
  text += fmt::format(
      "{} of {}, {} looked at, {} with enough neighbours; points from {} to {} m, neighbours within {} m\n",
      counted(q.windows, "window"), counted(flags.config.window_sweeps, "sweep"), counted(q.samples, "place"), q.places,
      flags.config.min_range_m, flags.config.max_range_m, flags.config.radius_m);
  text += fmt::format("{:<34} {:.2f} % ({})\n", "Planar places", 100 * q.planar_share, q.plane_rms_m.count);
  text += fmt::format("{:<34} median {:.3f}  mean {:.3f}  75 % {:.3f} mm\n", "RMS distance to the local plane",
                      kMillimetres * q.plane_rms_m.median, kMillimetres * q.plane_rms_m.mean,
                      kMillimetres * q.plane_rms_p75_m);
  text += fmt::format("{:<34} {:.3f} mm\n",
                      fmt::format("All places, no plane as {:.0f} mm", kMillimetres * no_plane_m(flags.config)),
                      kMillimetres * q.bounded_rms_m);
  return text + fmt::format("{:<34} {:.4f}\n", "Mean map entropy", q.mean_map_entropy.value_or(0));
}

int quality(const QualityFlags& flags) {
  const QualityRun run = measure(flags);
  for (const std::string& warning : run.source.warnings) {
    if (!flags.quiet) std::cerr << "rilo: warning: " << warning << '\n';
  }
  check_found(flags, run);
  std::cout << (flags.json ? json_text(quality_json(flags, run)) : quality_table(flags, run));
  return kSuccess;
}

void add_map_flags(CLI::App& command, MapQualityConfig& config) {
  constexpr std::int64_t kMany = 1'000'000'000;
  add_count(command, "--window", config.window_sweeps, kMany, "consecutive sweeps that make one map");
  add_count(command, "--sweep-step", config.sweep_step, kMany,
            "1: all of them go into it; 3: sweeps 0, 3, 6 and so on");
  add_number(command, "--min-range", config.min_range_m, 0, 1e4, "points nearer to the sensor (m) are dropped");
  add_number(command, "--max-range", config.max_range_m, 0, 1e4, "points farther away (m) are dropped");
  add_number(command, "--voxel", config.voxel_m, 0, 1e3, "one point of a sweep per voxel of this size (m); 0: all");
  add_number(command, "--radius", config.radius_m, 1e-6, 1e3, "of the neighbourhood that a plane is fitted to (m)");
  add_count(command, "--points", config.points_per_sweep, kMany, "at most that many points per sweep, at random");
  add_count(command, "--samples", config.samples_per_window, kMany, "places of a map that are looked at");
  add_count(command, "--seed", config.seed, kAnyCount, "of the random choice");
  add_count(command, "--threads", config.threads, 1024,
            "threads; 0: as many as the machine has; the result does not depend on it");
}

void add_flags(CLI::App& command, QualityFlags& flags) {
  command.add_option("DATA", flags.data, "folder or file with sweeps")->required()->check(path_given());
  command.add_option("POSES", flags.poses, "poses of the LiDAR, one per sweep")->required()->check(path_given());
  add_count(command, "--start", flags.start, kAnyCount,
            "skip that many sweeps; by index, the next one has the first pose, as after run --start");
  add_count(command, "--count", flags.count, kAnyCount, "look at that many sweeps; 0: all");
  add_choice(
      command, "--associate", [&flags](const std::string& text) { flags.pairing.pairing = parse_pairing(text); },
      {"auto", "index", "stamp"},
      "pair poses with sweeps by index or by stamp. Default: auto, by stamp when POSES has stamps");
  add_number(command, "--max-gap-s", flags.pairing.max_gap_s, 0, 1e6,
             "largest distance of a pose's stamp from the middle of its sweep");
  add_map_flags(command, flags.config);
  command.add_flag("--quiet", flags.quiet, "no progress, no warnings");
  command.add_flag("--json", flags.json, "print JSON");
  add_source_flags(command, flags.source);
}

}  // namespace

void add_quality_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<QualityFlags>();
  CLI::App* command = app.add_subcommand("quality", "how sharp a trajectory's map is; needs no ground truth");
  command->footer(kQualityFooter);
  add_flags(*command, *flags);
  command->callback([flags, &exit_code] { exit_code = quality(*flags); });
}

}  // namespace rilo::cli
