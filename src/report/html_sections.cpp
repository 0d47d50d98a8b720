#include "html_sections.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "figures.hpp"
#include "html_text.hpp"

namespace rilo {

namespace {

std::string cards(const RunReport& run) {
  std::string html = "<div class=\"cards\">\n";
  for (const Figure& figure : headline_figures(run)) {
    html += fmt::format(
        "<div class=\"card\"><div class=\"label\">{}</div><div class=\"value\">{}<span class=\"unit\">{}</span></div>"
        "<div class=\"note\">{}</div></div>\n",
        escaped(figure.label), escaped(figure.value), escaped(figure.unit), escaped(figure.note));
  }
  return html + "</div>\n";
}

/// Size of the run in one line: sweeps, distance, statuses.
std::string summary_line(const RunReport& run) {
  std::string text = fmt::format("{} sweep{}", run.estimate.size(), run.estimate.size() == 1 ? "" : "s");
  if (!run.estimate.empty()) {
    const double path_m = run.evaluation ? run.evaluation->path_m : path_lengths(run.estimate).back();
    text += fmt::format(" · {} m{}", number(path_m, 1), run.evaluation ? " of true path" : "");
  }
  for (const auto& [status, count] : status_counts(run.sweeps)) {
    text += fmt::format(" · {} {}", count, status);
  }
  return escaped(text);
}

/// A sentence where a tenth of the sweeps or more is lost.
std::string loss_notice(const RunReport& run) {
  constexpr std::size_t kOneOf = 10;
  const auto lost =
      static_cast<std::size_t>(std::count_if(run.sweeps.begin(), run.sweeps.end(), [](const SweepResult& sweep) {
        return sweep.status == OdometryStatus::kLost;
      }));
  if (lost == 0 || kOneOf * lost < run.sweeps.size()) return "";
  return fmt::format("<p class=\"notice\">{} of {} sweeps are lost: the path is not to be trusted there.</p>\n", lost,
                     run.sweeps.size());
}

std::string header(const RunReport& run) {
  std::string html = fmt::format("<header><h2>{}</h2>\n", title_of(run));
  if (!run.dataset.empty()) html += fmt::format("<p class=\"dataset\">{}</p>\n", escaped(run.dataset));
  html += fmt::format("<p class=\"summary\">{}</p>\n", summary_line(run));
  if (!run.notice.empty()) html += fmt::format("<p class=\"notice\">{}</p>\n", escaped(run.notice));
  return html + loss_notice(run) + "</header>\n";
}

std::string error_row(const char* name, const char* unit, const ErrorSummary& s, int digits) {
  if (s.count == 0) return "";
  return fmt::format(
      "<tr><th>{} <span class=\"unit\">{}</span></th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", name, unit,
      number(s.rmse, digits), number(s.mean, digits), number(s.median, digits), number(s.max, digits));
}

std::string accuracy_panel(const Evaluation& e) {
  std::string html =
      "<section class=\"panel half\"><h3>Accuracy</h3><p class=\"caption\">Aligned: rigid motion without scale, of "
      "the positions alone; along a straight path they leave the roll free, and with it the aligned angles. "
      "Unaligned: first poses made equal.</p><div class=\"scroll\" tabindex=\"0\"><table "
      "class=\"numbers\"><thead><tr><th></th>"
      "<th>rmse</th><th>mean</th><th>median</th><th>max</th></tr></thead><tbody>\n";
  html += error_row("APE aligned", "m", e.ape.translation_m, 3);
  html += error_row("APE aligned", "°", e.ape.rotation_deg, 3);
  html += error_row("APE unaligned", "m", e.ape_unaligned.translation_m, 3);
  html += error_row("APE unaligned", "°", e.ape_unaligned.rotation_deg, 3);
  html += error_row("RPE per metre", "m/m", e.rpe_metre.translation_m, 4);
  html += error_row("RPE per metre", "°/m", e.rpe_metre.rotation_deg, 4);
  html += error_row("RPE per sweep", "m", e.rpe_frame.translation_m, 4);
  html += error_row("RPE per sweep", "°", e.rpe_frame.rotation_deg, 4);
  return html + "</tbody></table></div></section>\n";
}

std::string segment_panel(const KittiError& kitti) {
  const std::vector<KittiLengthError> rows = kitti.per_length();
  std::string html =
      "<section class=\"panel half\"><h3>Drift by segment length</h3><p class=\"caption\">KITTI devkit: starts every "
      "10 sweeps.";
  html += kitti.short_path ? " The path is below 150 m, so the lengths are eighths of 80 % of it." : "";
  html += "</p>";
  if (rows.empty()) return html + "<p>The path is too short for any segment.</p></section>\n";
  html +=
      "<div class=\"scroll\" tabindex=\"0\"><table class=\"numbers\"><thead><tr><th>length <span "
      "class=\"unit\">m</span></th>"
      "<th>segments</th><th>t_rel <span class=\"unit\">%</span></th><th class=\"bar\"></th>"
      "<th>r_rel <span class=\"unit\">°/100 m</span></th></tr></thead><tbody>\n";
  double largest = 1e-12;
  for (const KittiLengthError& row : rows) largest = std::max(largest, row.t_rel_pct);
  for (const KittiLengthError& row : rows) {
    html += fmt::format(
        "<tr><th>{}</th><td>{}</td><td>{}</td><td class=\"bar\"><i style=\"width:{:.1f}%\"></i></td><td>{}</td></tr>\n",
        number(row.length_m, kitti.short_path ? 1 : 0), row.count, number(row.t_rel_pct, 3),
        100.0 * row.t_rel_pct / largest, number(row.r_rel_deg_100m, 3));
  }
  return html + "</tbody></table></div></section>\n";
}

std::string trajectory_panels(const RunReport& run) {
  const bool with_truth = !run.truth.empty();
  std::string html = chart_panel("top", "tall", with_truth ? "Trajectory against truth" : "Trajectory",
                                 "Seen from above, equal axes, metres. Move over it: every chart follows.");
  html += chart_panel("side", "side", "Side view", "Height z over distance travelled, metres.");
  if (run.evaluation) {
    html += chart_panel("error", "side", "Error over distance",
                        "Distance to the true position, first poses made equal, metres.");
  } else {
    html += chart_panel("speed", "side", "Travel per sweep", "Distance between consecutive poses, metres.");
  }
  if (!run.map_points.empty()) {
    html += chart_panel("map", "full", "Map from above",
                        "Points of the map, coloured by height above the local ground, and the trajectory.");
  }
  return html;
}

std::string sweep_panels(const RunReport& run) {
  std::string html;
  if (timing_of(run.sweeps).max_ms > 0.0) {
    html += chart_panel("timing", "wide", "Time per sweep", "Motion compensation to map update, milliseconds.") +
            chart_panel("histogram", "narrow", "Distribution of the time", "Sweeps by time, milliseconds.");
  }
  return html + chart_panel("status", "full", "Status and initial pose", "What the odometry said about each sweep.") +
         chart_panel(
             "strips", "full", "Registration, sweep by sweep",
             "Adaptive threshold σ_th, inliers per point and iterations of the fine registration. A point on no "
             "plane may have three correspondences, so that there can be more inliers than points. No "
             "registration, no inliers: the curve is interrupted.");
}

}  // namespace

std::string chart_panel(const char* chart, const char* size, const char* heading, const char* caption) {
  return fmt::format(
      "<section class=\"panel {1}\"><h3>{2}</h3><p class=\"caption\">{3}</p>"
      "<div class=\"chart\" data-chart=\"{0}\"></div></section>\n",
      chart, size, heading, caption);
}

std::string facts_panel(const std::vector<std::pair<std::string, std::string>>& facts) {
  if (facts.empty()) return "";
  std::string html =
      "<section class=\"panel full\"><h3>How this was made</h3><p class=\"caption\">Everything needed to repeat it."
      "</p><table class=\"facts\"><tbody>\n";
  for (const auto& [key, value] : facts) {
    html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(key), escaped(value));
  }
  return html + "</tbody></table></section>\n";
}

std::string title_of(const RunReport& run) { return run.title.empty() ? "LiDAR odometry run" : escaped(run.title); }

std::string run_section(const RunReport& run) {
  std::string html = "<article class=\"run\">\n" + header(run) + cards(run) + "<div class=\"grid\">\n";
  html += run.estimate.empty() ? "" : trajectory_panels(run);
  if (run.evaluation) {
    html +=
        chart_panel("axes", "half", "Drift by axis", "Estimate minus truth along the axes of the true pose, metres.") +
        chart_panel("rotation", "half", "Rotation error over distance", "First poses made equal, degrees.");
    html += accuracy_panel(*run.evaluation) + segment_panel(run.evaluation->kitti);
  }
  html += run.sweeps.empty() ? "" : sweep_panels(run);
  html += facts_panel(run.facts) + "</div>\n";
  return html + chart_data(run) + "</article>\n";
}

}  // namespace rilo
