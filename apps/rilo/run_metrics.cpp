// Figures of a run: metrics.json and the lines printed at the end.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "evaluation_output.hpp"
#include "rilo/geometry/degrees.hpp"
#include "run_record.hpp"
#include "source_flags.hpp"
#include "text.hpp"
#include "version.hpp"

namespace rilo::cli {

namespace {

/// Nearest-rank percentile of sorted values.
double percentile(const std::vector<double>& sorted, double percent) {
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

nlohmann::json timing(const RunRecord& run) {
  std::vector<double> ms;
  for (const SweepResult& result : run.results) {
    ms.push_back(result.stats.times.total_ms);
  }
  if (ms.empty()) {
    return nullptr;
  }
  double sum = 0.0;
  for (const double value : ms) {
    sum += value;
  }
  std::sort(ms.begin(), ms.end());
  return {{"mean", sum / static_cast<double>(ms.size())},
          {"median", percentile(ms, 50)},
          {"p95", percentile(ms, 95)},
          {"p99", percentile(ms, 99)},
          {"max", ms.back()}};
}

nlohmann::json stage_means(const RunRecord& run) {
  StageTimes sum;
  for (const SweepResult& result : run.results) {
    const StageTimes& t = result.stats.times;
    sum.preprocess_ms += t.preprocess_ms;
    sum.initial_pose_ms += t.initial_pose_ms;
    sum.registration_ms += t.registration_ms;
    sum.map_ms += t.map_ms;
  }
  const double n = std::max<double>(1.0, static_cast<double>(run.results.size()));
  return {{"preprocess", sum.preprocess_ms / n},
          {"initial_pose", sum.initial_pose_ms / n},
          {"registration", sum.registration_ms / n},
          {"map", sum.map_ms / n}};
}

nlohmann::json counts(const RunRecord& run) {
  std::map<std::string, std::size_t> status;
  std::map<std::string, std::size_t> initial;
  std::map<std::string, std::size_t> reasons;
  std::size_t coarse_runs = 0;
  double iterations = 0;
  // All of them, those that never occurred too: scripts need not ask whether a name is there.
  for (const auto source : {InitialPoseSource::kIdentity, InitialPoseSource::kPrediction, InitialPoseSource::kCoarse}) {
    initial[std::string(to_string(source))] = 0;
  }
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    status[std::string(to_string(static_cast<OdometryStatus>(i)))] = 0;
  }
  for (const SweepResult& result : run.results) {
    ++status[std::string(to_string(result.status))];
    ++initial[std::string(to_string(result.stats.initial_pose))];
    ++reasons[std::string(to_string(result.stats.initial_pose_reason))];
    coarse_runs += result.stats.coarse_ran ? 1 : 0;
    iterations += result.stats.iterations;
  }
  return {{"status", status},
          {"initial_pose", initial},
          {"initial_pose_reasons", reasons},
          {"coarse_runs", coarse_runs},
          {"mean_iterations", iterations / std::max<double>(1.0, static_cast<double>(run.results.size()))}};
}

/// What was left undone for want of time.
nlohmann::json budget(const RunRecord& run) {
  const auto count = [&](bool SweepStats::*flag) {
    return std::count_if(run.results.begin(), run.results.end(),
                         [&](const SweepResult& result) { return result.stats.*flag; });
  };
  return {{"sweep_ms", run.config.budget.sweep_ms},
          {"points_cut", count(&SweepStats::points_cut)},
          {"coarse_cut", count(&SweepStats::coarse_cut)},
          {"over_budget", count(&SweepStats::over_budget)}};
}

/// What the run found out about the sensor's angles; the correction given on the command line comes on top.
nlohmann::json sensor_angles(const RunRecord& run) {
  nlohmann::json figures = {{"elevation_offset_deg", nullptr},     {"elevation_offset_sigma_deg", nullptr},
                            {"elevation_offset_applied_deg", 0.0}, {"started_over_after_sweeps", nullptr},
                            {"beam_elevation_rms_deg", 0.0},       {"beam_azimuth_rms_deg", 0.0}};
  if (run.started_over_after) {
    figures["started_over_after_sweeps"] = *run.started_over_after;
  }
  if (run.results.empty()) {
    return figures;
  }
  const SweepStats& last = run.results.back().stats;
  figures["beam_elevation_rms_deg"] = kDegPerRad * last.beam_elevation_rms_rad;
  figures["beam_azimuth_rms_deg"] = kDegPerRad * last.beam_azimuth_rms_rad;
  if (!run.config.elevation.enabled) {
    return figures;
  }
  if (std::isfinite(last.elevation_offset_sigma_rad)) {
    figures["elevation_offset_deg"] = kDegPerRad * last.elevation_offset_rad;
    figures["elevation_offset_sigma_deg"] = kDegPerRad * last.elevation_offset_sigma_rad;
  }
  figures["elevation_offset_applied_deg"] = kDegPerRad * last.elevation_applied_rad;
  return figures;
}

}  // namespace

nlohmann::json run_metrics(const RunRecord& run) {
  nlohmann::json metrics = {
      {"rilo_version", kVersion},
      {"command", run.command_line},
      {"data", valid_utf8(run.data.string())},
      {"format", run.source.kind + ", " + run.source.format},
      {"frames", run.results.size()},
      {"interrupted", run.signal != 0},
      {"ms", timing(run)},
      {"ms_note", "all stages, deskew to map update; reading excluded; every sweep counts, the first ones too"},
      {"stage_mean_ms", stage_means(run)},
      {"wall_s", run.wall_s},
      {"peak_rss_mb", run.peak_rss_mb},
      {"threads", run.threads},
      {"pose_instant", to_string(run.pose_instant)},
      {"point_times", run.source.point_times},
      {"motion_compensation", run.source.has_point_times && run.config.preprocess.deskew},
      {"elevation_correction_deg", run.source.elevation_correction_deg},
      {"topic", run.source.topic},
      {"frame_id", run.source.frame_id},
      {"bad_sweeps", run.source.bad_sweeps},
      {"stamp_faults", stamp_faults_json(run.source.faults)},
      {"warnings", run.source.warnings},
  };
  metrics.update(counts(run));
  if (run.config.budget.sweep_ms > 0.0) {
    metrics["budget"] = budget(run);
  }
  metrics.update(sensor_angles(run));
  if (!run.error.empty()) {
    metrics["error"] = run.error;
  }
  if (!run.truth_error.empty()) metrics["truth_error"] = run.truth_error;
  if (run.evaluation) {
    metrics["evaluation"] = evaluation_json(*run.evaluation);
    metrics["evaluation"]["truth"] = run.truth->file;
    metrics["evaluation"]["truth_instant"] = run.truth->instant;
    // The headline figures at the top level too, where scripts look first.
    for (const char* key : {"t_rel_pct", "r_rel_deg_per_100m"}) {
      metrics[key] = metrics["evaluation"][key];
    }
    metrics["ape_rmse_m"] = metrics["evaluation"]["ape_m"]["rmse"];
  }
  return metrics;
}

std::string run_summary(const nlohmann::json& m) {
  std::string text = fmt::format("{} of {}{}\n", counted(m["frames"].get<std::size_t>(), "sweep"),
                                 m["data"].get<std::string>(), m["interrupted"].get<bool>() ? " (interrupted)" : "");
  if (!m["ms"].is_null()) {
    text +=
        fmt::format("time per sweep  mean {:.1f} ms, median {:.1f}, p95 {:.1f}, p99 {:.1f}, max {:.1f}  ({} threads)\n",
                    m["ms"]["mean"].get<double>(), m["ms"]["median"].get<double>(), m["ms"]["p95"].get<double>(),
                    m["ms"]["p99"].get<double>(), m["ms"]["max"].get<double>(), m["threads"].get<int>());
  }
  text += fmt::format("peak memory     {:.0f} MB\n", m["peak_rss_mb"].get<double>());
  text += "status         ";
  for (const auto& [name, count] : m["status"].items()) {
    if (count.get<std::size_t>() > 0) {
      text += fmt::format(" {} {}", name, count.get<std::size_t>());
    }
  }
  if (m.contains("budget")) {
    const auto& b = m["budget"];
    text += fmt::format("\nbudget {:.1f} ms  fewer points on {} sweeps, coarse stage cut on {}, over budget on {}",
                        b["sweep_ms"].get<double>(), b["points_cut"].get<int>(), b["coarse_cut"].get<int>(),
                        b["over_budget"].get<int>());
  }
  text += fmt::format("\nposes at        {} of the sweep; point times: {}; elevation correction {} deg\n",
                      m["pose_instant"].get<std::string>(), m["point_times"].get<std::string>(),
                      m["elevation_correction_deg"].get<double>());
  if (!m["elevation_offset_deg"].is_null()) {
    text += fmt::format("elevation error {:+.3f} ± {:.3f} deg found; {:+.3f} corrected\n",
                        m["elevation_offset_deg"].get<double>(), m["elevation_offset_sigma_deg"].get<double>(),
                        m["elevation_offset_applied_deg"].get<double>());
    if (!m["started_over_after_sweeps"].is_null()) {
      text += fmt::format("                from the start: certain after {} sweeps, then started over\n",
                          m["started_over_after_sweeps"].get<std::size_t>());
    }
  }
  if (m["beam_elevation_rms_deg"].get<double>() > 0.0 || m["beam_azimuth_rms_deg"].get<double>() > 0.0) {
    text += fmt::format("single beams    corrected by {:.3f} deg in elevation, {:.3f} in azimuth (rms)\n",
                        m["beam_elevation_rms_deg"].get<double>(), m["beam_azimuth_rms_deg"].get<double>());
  }
  if (m.contains("evaluation")) {
    const auto& e = m["evaluation"];
    text += fmt::format("against truth   APE {:.4f} m aligned, {:.4f} m unaligned; path {:.1f} m",
                        e["ape_m"]["rmse"].get<double>(), e["ape_unaligned_m"]["rmse"].get<double>(),
                        e["path_m"].get<double>());
    if (!e["t_rel_pct"].is_null()) {
      text += fmt::format("; t_rel {:.4f} %, r_rel {:.4f} deg/100m", e["t_rel_pct"].get<double>(),
                          e["r_rel_deg_per_100m"].get<double>());
    }
    text += "\n";
  }
  return text;
}

}  // namespace rilo::cli
