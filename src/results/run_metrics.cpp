#include "results/run_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "console/text.hpp"
#include "console/version.hpp"
#include "geometry/degrees.hpp"
#include "report/figures.hpp"

namespace rilo {

namespace {

TimingMetrics timing(const RunRecord& run) {
  if (run.results.empty()) return {};
  const TimingFigures t = timing_of(run.results);
  return {t.mean_ms, t.median_ms, t.p95_ms, t.p99_ms, t.max_ms};
}

StageMetrics stage_means(const RunRecord& run) {
  StageMetrics means;
  const double n = std::max<double>(1.0, static_cast<double>(run.results.size()));
  for (const SweepResult& result : run.results) {
    const StageTimes& t = result.stats.times;
    means.preprocess += t.preprocess_ms / n;
    means.initial_pose += t.initial_pose_ms / n;
    means.registration += t.registration_ms / n;
    means.map += t.map_ms / n;
  }
  return means;
}

void count_sweeps(const RunRecord& run, RunMetrics& metrics) {
  // All names, those that never occurred too: scripts need not ask whether one is there.
  for (const auto source : {InitialPoseSource::kIdentity, InitialPoseSource::kPrediction, InitialPoseSource::kCoarse}) {
    metrics.initial_pose[std::string(to_string(source))] = 0;
  }
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    metrics.status[std::string(to_string(static_cast<OdometryStatus>(i)))] = 0;
  }
  double iterations = 0;
  for (const SweepResult& result : run.results) {
    ++metrics.status[std::string(to_string(result.status))];
    const LossCause cause = result.stats.loss_cause;
    if (cause != LossCause::kNone) ++metrics.loss_causes[std::string(to_string(cause))];
    ++metrics.initial_pose[std::string(to_string(result.stats.initial_pose))];
    ++metrics.initial_pose_reasons[std::string(to_string(result.stats.initial_pose_reason))];
    metrics.coarse_runs += result.stats.coarse_ran ? 1 : 0;
    iterations += result.stats.iterations;
  }
  metrics.mean_iterations = iterations / std::max<double>(1.0, static_cast<double>(run.results.size()));
}

std::optional<BudgetMetrics> budget(const RunRecord& run) {
  if (run.config.budget.sweep_ms <= 0.0) return std::nullopt;
  const auto count = [&](bool SweepStats::*flag) {
    return static_cast<std::size_t>(std::count_if(run.results.begin(), run.results.end(),
                                                  [&](const SweepResult& result) { return result.stats.*flag; }));
  };
  return BudgetMetrics{run.config.budget.sweep_ms, count(&SweepStats::points_cut), count(&SweepStats::coarse_cut),
                       count(&SweepStats::over_budget)};
}

void add_flakes(const RunRecord& run, RunMetrics& metrics) {
  std::size_t sweeps = 0;
  double flakes = 0;
  double valid = 0;
  for (const SweepResult& result : run.results) {
    if (result.stats.points_isolated == 0) continue;
    ++sweeps;
    flakes += static_cast<double>(result.stats.points_isolated);
    valid += static_cast<double>(result.stats.points_valid);
  }
  if (sweeps == 0) return;
  metrics.flake_sweeps = sweeps;
  metrics.flakes_pct = 100.0 * flakes / (flakes + valid);
}

// What the run found out about the sensor's angles; the correction given on the command line comes on top.
void add_sensor_angles(const RunRecord& run, RunMetrics& metrics) {
  metrics.calibration = valid_utf8(run.calibration.string());
  metrics.elevation_given_deg = run.elevation_given_deg;
  metrics.elevation_initial_deg = run.restart ? run.restart->elevation_offset_deg : metrics.elevation_given_deg;
  metrics.elevation_offset_applied_deg = 0.0;
  if (run.restart) metrics.started_over_after_sweeps = run.restart->after_sweeps;
  if (run.results.empty()) return;
  const SweepStats& last = run.results.back().stats;
  metrics.beam_elevation_rms_deg = kDegPerRad * last.beam_elevation_rms_rad;
  metrics.beam_azimuth_rms_deg = kDegPerRad * last.beam_azimuth_rms_rad;
  metrics.elevation_offset_applied_deg = kDegPerRad * last.elevation_applied_rad;
  if (run.config.elevation.enabled && std::isfinite(last.elevation_offset_sigma_rad)) {
    metrics.elevation_offset_deg = kDegPerRad * last.elevation_offset_rad;
    metrics.elevation_offset_sigma_deg = kDegPerRad * last.elevation_offset_sigma_rad;
  }
}

void add_data(const RunRecord& run, RunMetrics& metrics) {
  const SourceInfo& source = run.source;
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(run.data, error).lexically_normal();
  metrics.data = valid_utf8(run.data.string());
  if (!error) metrics.data_path = valid_utf8(absolute.string());
  metrics.format = source.kind + ", " + source.format;
  metrics.pose_instant = to_string(run.pose_instant);
  metrics.point_times = source.point_times;
  metrics.motion_compensation = source.has_point_times && run.config.preprocess.deskew;
  if (was_tried(run)) metrics.compensation = trial_metrics(run.trial);
  metrics.elevation_correction_deg = source.elevation_correction_deg;
  metrics.topic = source.topic;
  metrics.frame_id = source.frame_id;
  metrics.parts = source.parts;
  metrics.bad_sweeps = source.bad_sweeps;
  metrics.stamp_faults = source.faults;
  metrics.warnings = source.warnings;
}

// Without an error there is no figure: 0 would be a perfect one.
ErrorMetrics summary(const ErrorSummary& s) {
  if (s.count == 0) return {};
  return {s.rmse, s.mean, s.std, s.median, s.max};
}

}  // namespace

std::string cones_text(std::size_t on_cones, std::size_t off_cones) {
  if (on_cones + off_cones == 0) return "";
  return on_cones >= off_cones ? fmt::format(", {} lie on the cones of the beams", on_cones)
                               : fmt::format(", {} do not lie on the cones of the beams", off_cones);
}

bool was_tried(const SessionResult& run) { return run.trial.times != PointTimes::kAuto && run.trial.sweeps > 0; }

TrialMetrics trial_metrics(const CompensationTrial& trial) {
  return {std::string(to_string(trial.times)),
          trial.sweeps,
          trial.better,
          trial.on_cones,
          trial.off_cones,
          trial.lost,
          trial.raw(),
          trial.compensated()};
}

std::string trial_outcome(const CompensationTrial& trial) {
  return fmt::format("{} of {} fit better with the times of the points' {}{}: {}", trial.better,
                     counted(trial.sweeps, "sweep"), to_string(trial.times),
                     cones_text(trial.on_cones, trial.off_cones),
                     trial.raw()           ? "taken as raw"
                     : trial.compensated() ? "taken as compensated"
                                           : "not certain, taken as they are");
}

EvaluationMetrics evaluation_metrics(const Evaluation& e) {
  EvaluationMetrics metrics;
  metrics.poses = e.poses;
  metrics.path_m = e.path_m;
  metrics.t_rel_pct = e.kitti.t_rel_pct();
  metrics.r_rel_deg_per_100m = e.kitti.r_rel_deg_100m();
  metrics.t_rel_protocol = e.kitti.short_path ? "KITTI, lengths eighths of 80 % of the path" : "KITTI, 100 … 800 m";
  metrics.ape_m = summary(e.ape.translation_m);
  metrics.ape_rotation_deg = summary(e.ape.rotation_deg);
  metrics.ape_unaligned_m = summary(e.ape_unaligned.translation_m);
  metrics.ape_unaligned_rotation_deg = summary(e.ape_unaligned.rotation_deg);
  metrics.rpe_frame_m = summary(e.rpe_frame.translation_m);
  metrics.rpe_frame_deg = summary(e.rpe_frame.rotation_deg);
  metrics.rpe_metre_m_per_m = summary(e.rpe_metre.translation_m);
  metrics.rpe_metre_deg_per_m = summary(e.rpe_metre.rotation_deg);
  metrics.end_error_m = e.end_error_m;
  if (e.path_m > 0) metrics.end_error_pct = e.end_error_pct;
  return metrics;
}

EvaluationMetrics evaluation_metrics(const Evaluation& e, const TruthMatch& truth) {
  EvaluationMetrics metrics = evaluation_metrics(e);
  metrics.truth = truth.file;
  metrics.truth_instant = truth.instant;
  return metrics;
}

RunMetrics run_metrics(const RunRecord& run) {
  RunMetrics metrics;
  metrics.rilo_version = kVersion;
  metrics.command = run.command_line;
  metrics.frames = run.results.size();
  metrics.interrupted = run.signal != 0;
  metrics.error = run.error;
  metrics.ms = timing(run);
  metrics.ms_note = "all stages, deskew to map update; reading excluded; every sweep counts, the first ones too";
  metrics.stage_mean_ms = stage_means(run);
  metrics.wall_s = run.wall_s;
  metrics.peak_rss_mb = run.peak_rss_mb;
  metrics.threads = run.threads;
  add_data(run, metrics);
  count_sweeps(run, metrics);
  metrics.budget = budget(run);
  add_flakes(run, metrics);
  add_sensor_angles(run, metrics);
  metrics.truth_error = run.truth_error;
  if (run.evaluation) metrics.evaluation = evaluation_metrics(*run.evaluation, *run.truth);
  return metrics;
}

}  // namespace rilo
