#include "results/run_report.hpp"

#include <string>

#include <fmt/format.h>

#include "console/text.hpp"
#include "results/run_metrics.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

namespace {

std::string notice_of(const RunRecord& run) {
  if (!run.error.empty()) return valid_utf8("The run ended at an error; this is the part before. " + run.error);
  if (run.signal != 0) return "The run was interrupted; this is the part before.";
  return "";
}

std::string compensation_of(const RunRecord& run) {
  if (!run.config.preprocess.deskew) return "off (preprocess.deskew)";
  return run.source.has_point_times ? "on" : "off (no point times)";
}

std::string elevation_of(const RunMetrics& metrics) {
  if (!metrics.elevation_offset_deg) return "not estimated";
  return fmt::format("estimated {:+.3f} ± {:.3f}°, applied {:+.3f}°", *metrics.elevation_offset_deg,
                     metrics.elevation_offset_sigma_deg.value_or(0), metrics.elevation_offset_applied_deg.value_or(0));
}

void add_facts(const RunRecord& run, const RunMetrics& metrics, RunReport& report) {
  report.facts = {{"Command", run.command_line},
                  {"Rilo", metrics.rilo_version},
                  {"Format", run.source.kind + ", " + run.source.format},
                  {"Threads", std::to_string(run.threads)},
                  {"Pose time", std::string(to_string(run.pose_instant)) + " of the sweep"},
                  {"Point times", valid_utf8(run.source.point_times)},
                  {"Deskewing", compensation_of(run)},
                  {"Elevation correction given", fmt::format("{}°", run.source.elevation_correction_deg)},
                  {"Calibration given", metrics.calibration.empty() ? "none" : metrics.calibration},
                  {"Elevation offset of the sensor", elevation_of(metrics)},
                  {"Per-beam calibration", fmt::format("rms {:.3f}° in elevation, {:.3f}° in azimuth",
                                                       metrics.beam_elevation_rms_deg, metrics.beam_azimuth_rms_deg)},
                  {"Time measured", metrics.ms_note}};
  if (was_tried(run)) report.facts.emplace_back("Raw or compensated", trial_outcome(run.trial));
  if (run.truth) {
    report.facts.emplace_back("Ground truth", valid_utf8(run.truth->file + " (" + run.truth->instant + ")"));
  }
  for (const std::string& warning : run.source.warnings) report.facts.emplace_back("Warning", valid_utf8(warning));
}

}  // namespace

RunReport report_of(const RunRecord& run, const RunMetrics& metrics) {
  RunReport report;
  const std::string data = metrics.data.empty() ? run.data.string() : metrics.data;  // as typed
  report.title = valid_utf8("Rilo: " + last_name(data));
  report.dataset = valid_utf8(data);
  report.notice = notice_of(run);
  add_facts(run, metrics, report);
  report.sweeps = run.results;
  report.numbers = run.indices;
  for (const SweepResult& result : run.results) report.estimate.push_back(result.T_odom_lidar);
  if (run.truth) {
    const SE3 T_odom_world = run.truth->estimate.front() * run.truth->truth.front().inverse();
    report.truth = moved(run.truth->truth, T_odom_world);
  }
  report.evaluation = run.evaluation;
  report.map_points = run.map.points;
  report.sweep_period_ms = run.source.period_s * 1e3;
  report.peak_rss_mb = run.peak_rss_mb;
  return report;
}

}  // namespace rilo
