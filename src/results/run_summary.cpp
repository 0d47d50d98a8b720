#include <fmt/format.h>

#include "console/text.hpp"
#include "report/figures.hpp"
#include "results/run_metrics.hpp"

namespace rilo {

namespace {

std::string effort(const RunMetrics& m) {
  std::string text;
  if (m.timed()) {
    text = fmt::format("time per sweep  mean {:.1f} ms, median {:.1f}, p95 {:.1f}, p99 {:.1f}, max {:.1f}  ({})\n",
                       m.ms.mean.value_or(0), m.ms.median.value_or(0), m.ms.p95.value_or(0), m.ms.p99.value_or(0),
                       m.ms.max.value_or(0), counted(static_cast<std::size_t>(m.threads), "thread"));
  }
  return text + fmt::format("peak memory     {:.0f} MiB\n", m.peak_rss_mb.value_or(0));
}

/// Those that occurred.
std::string listed(const char* title, const Counts& counts) {
  std::string text = fmt::format("{:<15}", title);
  for (const auto& [name, count] : counts) {
    if (count > 0) text += fmt::format(" {} {}", name, count);
  }
  return text;
}

std::string statuses(const RunMetrics& m) {
  std::string text = listed("status", m.status);
  if (!m.loss_causes.empty()) text += "\n" + listed("lost because", m.loss_causes);
  if (m.budget) {
    text += fmt::format("\nbudget {:<8} fewer points on {}, coarse stage cut on {}, over budget on {}",
                        fmt::format("{:.1f} ms", m.budget->sweep_ms), counted(m.budget->points_cut, "sweep"),
                        m.budget->coarse_cut, m.budget->over_budget);
  }
  return text + "\n";
}

std::string flakes(const RunMetrics& m) {
  if (!m.flake_sweeps) return "";
  return fmt::format("flakes          {:.0f} % of the returns dropped, in {}: snow or rain\n", m.flakes_pct.value_or(0),
                     counted(*m.flake_sweeps, "sweep"));
}

// What comes from outside: the points come with the one, the first pass begins with the other on top (of
// elevation.initial_deg or a calibration).
std::string given_angles(const RunMetrics& m) {
  const double points_deg = m.elevation_correction_deg.value_or(0);
  const double initial_deg = m.elevation_given_deg.value_or(0);
  std::string text;
  if (points_deg != 0.0) text = fmt::format("{:+.3f} deg (--elevation-correction)", points_deg);
  if (initial_deg != 0.0) {
    text += fmt::format("{}{:+.3f} deg to begin with", text.empty() ? "" : " and ", initial_deg);
    if (points_deg != 0.0) text += fmt::format(", {:+.3f} deg together", points_deg + initial_deg);
  }
  return text.empty() ? "" : "elevation given " + text + "\n";
}

// One name for each of the three: given from outside, estimated, applied on top of what --elevation-correction gives.
std::string angles(const RunMetrics& m) {
  std::string text = m.calibration.empty() ? "" : "calibration     " + m.calibration + "\n";
  text += given_angles(m);
  if (m.elevation_offset_deg) {
    text += fmt::format("elev. offset    estimated {:+.3f} ± {:.3f} deg, applied {:+.3f} deg", *m.elevation_offset_deg,
                        m.elevation_offset_sigma_deg.value_or(0), m.elevation_offset_applied_deg.value_or(0));
    const double from_first_deg = m.started_over_after_sweeps ? m.elevation_initial_deg.value_or(0) : 0.0;
    if (from_first_deg != 0.0) text += fmt::format(" at last, {:+.3f} deg from the first sweep on", from_first_deg);
    text += "\n";
  }
  if (m.beam_elevation_rms_deg > 0.0 || m.beam_azimuth_rms_deg > 0.0) {
    text += fmt::format("per-beam calib. rms {:.3f} deg in elevation, {:.3f} in azimuth\n", m.beam_elevation_rms_deg,
                        m.beam_azimuth_rms_deg);
  }
  if (m.started_over_after_sweeps) {
    text += fmt::format("passes          2: restarted after {} with what they say\n",
                        counted(*m.started_over_after_sweeps, "sweep"));
  }
  return text;
}

std::string against_truth(const RunMetrics& m) {
  if (!m.evaluated()) return "";
  const EvaluationMetrics& e = m.evaluation;
  std::string text = fmt::format("against truth   APE {:.4f} m aligned, {:.4f} m unaligned; path {:.1f} m",
                                 e.ape_m.rmse.value_or(0), e.ape_unaligned_m.rmse.value_or(0), e.path_m.value_or(0));
  if (e.t_rel_pct && e.path_m.value_or(0) >= kLeastPathM) {
    text += fmt::format("; t_rel {:.4f} %, r_rel {:.4f} deg/100m", *e.t_rel_pct, e.r_rel_deg_per_100m.value_or(0));
  }
  return text + "\n";
}

}  // namespace

std::string run_summary(const RunMetrics& m) {
  const std::string deskewing = m.motion_compensation ? "on" : "off";
  return fmt::format("{} of {}{}\n", counted(m.frames.value_or(0), "sweep"), m.data,
                     m.interrupted ? " (interrupted)" : "") +
         effort(m) + statuses(m) + flakes(m) +
         fmt::format("pose time       {} of the sweep; deskewing: {}; point times: {}\n", m.pose_instant, deskewing,
                     m.point_times) +
         angles(m) + against_truth(m);
}

}  // namespace rilo
