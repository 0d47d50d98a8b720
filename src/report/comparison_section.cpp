#include <algorithm>

#include <fmt/format.h>

#include "comparison_figures.hpp"
#include "figure_table.hpp"
#include "figures.hpp"
#include "html_sections.hpp"
#include "html_text.hpp"

namespace rilo {

namespace {

using Json = nlohmann::json;
using Places = std::vector<std::size_t>;

constexpr std::size_t kColourCount = 6;  // --r0 … in the style sheet

std::string swatch(std::size_t place) { return fmt::format("<i class=\"swatch r{}\"></i>", place % kColourCount); }

std::string statuses(const RunReport& run) {
  std::string text;
  for (const auto& [status, count] : status_counts(run.sweeps)) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
  }
  return text.empty() ? "–" : escaped(text);
}

std::string figures_panel(const std::vector<RunReport>& runs, const Places& places) {
  std::vector<ExperimentFigure> columns = {{"", "Sweeps", "", 0}, {"", "True path", "m", 1}};
  for (const ComparisonFigure& figure : comparison_figures()) columns.push_back(figure.what);
  std::vector<FigureRow> rows;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const RunReport& run = runs[places[k]];
    FigureRow row{swatch(k) + escaped(name_of(run)), {}, statuses(run)};
    row.values.emplace_back(static_cast<double>(run.estimate.size()));
    row.values.push_back(run.evaluation ? std::optional(run.evaluation->path_m) : std::nullopt);
    for (const ComparisonFigure& figure : comparison_figures()) row.values.push_back(value_of(run, figure));
    rows.push_back(row);
  }
  return "<section class=\"panel full\"><h3>Runs compared</h3><p class=\"caption\">The best of each column is bold. "
         "APE rmse after SE(3) alignment, as papers print it; unaligned and end error with the first poses made equal; "
         "t_rel and r_rel as the KITTI devkit.</p>" +
         figure_table("run", columns, rows, "status of the sweeps", 2) + "</section>\n";
}

Json lengths_of(const RunReport& run) {
  Json rows = Json::array();
  for (const KittiLengthError& row : kitti_of(run).per_length()) {
    rows.push_back({rounded(row.length_m), rounded(row.t_rel_pct), rounded(row.r_rel_deg_100m), row.count});
  }
  return rows;
}

Json comparison_data(const std::vector<RunReport>& runs, const Places& places) {
  Json data{{"runs", places}, {"names", Json::array()}, {"lengths", Json::array()}, {"figures", Json::array()}};
  for (const std::size_t place : places) {
    data["names"].push_back(name_of(runs[place]));
    data["lengths"].push_back(lengths_of(runs[place]));
  }
  for (const ComparisonFigure& figure : comparison_figures()) {
    Json values = Json::array();
    for (const std::size_t place : places) {
      const auto value = value_of(runs[place], figure);
      values.push_back(value ? Json(*value) : Json(nullptr));
    }
    data["figures"].push_back(
        {{"title", figure.what.title}, {"unit", figure.what.unit}, {"digits", figure.what.digits}, {"values", values}});
  }
  return data;
}

template <typename Is>
bool any_of(const std::vector<RunReport>& runs, const Places& places, const Is& is) {
  return std::any_of(places.begin(), places.end(), [&](std::size_t place) { return is(runs[place]); });
}

std::string accuracy_panels(const std::vector<RunReport>& runs, const Places& places) {
  if (!any_of(runs, places, [](const RunReport& run) { return run.evaluation.has_value(); })) return "";
  std::string html = chart_panel("patherror", "side", "Error along the path",
                                 "Distance to the true position, first poses made equal.");
  html += chart_panel("trel", "half", "Translation drift by segment length",
                      "t_rel of the KITTI devkit: mean over all segments of a length.");
  html += chart_panel("rrel", "half", "Rotation drift by segment length", "r_rel over the same segments.");
  return html + chart_panel("drift", "full", "Drift by axis",
                            "Estimate minus truth along the axes of the true pose, first poses made equal.");
}

std::string effort_panels(const std::vector<RunReport>& runs, const Places& places) {
  std::string html;
  if (any_of(runs, places, [](const RunReport& run) { return timing_of(run.sweeps).max_ms > 0.0; })) {
    html += chart_panel("times", "half", "Time per sweep",
                        "Sweeps by time, the same scale for all; dashed: median and p99.");
  }
  if (any_of(runs, places, [](const RunReport& run) { return !run.sweeps.empty(); })) {
    html += chart_panel("statuses", "half", "Status, sweep by sweep", "What each run said about its sweeps.");
  }
  if (any_of(runs, places, [](const RunReport& run) { return !run.map_points.empty(); })) {
    html += chart_panel("maps", "full", "Maps from above",
                        "The same area at the same scale, coloured by height above the local ground; white: the "
                        "estimated path, orange: the true one.");
  }
  return html;
}

std::string sequence_article(const std::vector<RunReport>& runs, const std::string& sequence, const Places& places) {
  std::string html = fmt::format("<article class=\"comparison\">\n<header><h2>{}</h2>\n",
                                 sequence.empty() ? "Comparison" : escaped(sequence));
  const std::string& dataset = runs[places.front()].dataset;
  html += dataset.empty() ? "" : "<p class=\"dataset\">" + escaped(dataset) + "</p>\n";
  for (const std::size_t place : places) {
    const RunReport& run = runs[place];
    html += run.notice.empty()
                ? ""
                : "<p class=\"notice\"><b>" + escaped(name_of(run)) + ":</b> " + escaped(run.notice) + "</p>\n";
  }
  html +=
      "</header>\n<div class=\"chooser\" role=\"group\" aria-label=\"Runs shown in the charts\"></div>\n<div "
      "class=\"grid\">\n" +
      figures_panel(runs, places) +
      (places.size() > 1 ? chart_panel("bars", "full", "Side by side", "Shorter is better.") : "") +
      chart_panel("paths", "tall", "Trajectories", "Seen from above, equal axes, metres; first poses made equal.");
  html += chart_panel("heights", "side", "Height", "z over the distance travelled, from where the first run begins.");
  html += accuracy_panels(runs, places) + effort_panels(runs, places) + "</div>\n";
  return html + embedded_json(comparison_data(runs, places)) + "</article>\n";
}

}  // namespace

std::string comparison_sections(const std::vector<RunReport>& runs) {
  const auto groups = by_sequence(runs);
  std::string html;
  if (groups.size() > 1) html += experiment_section(experiment_of(runs));
  for (const auto& [sequence, places] : groups) html += sequence_article(runs, sequence, places);
  return html;
}

std::string folded_runs(const std::vector<RunReport>& runs) {
  std::string html = "<section class=\"folds\"><h2>Each run by itself</h2>\n";
  for (const RunReport& run : runs) {
    html += "<details><summary>" + escaped(name_of(run)) +
            (run.sequence.empty() ? "" : " <span class=\"unit\">" + escaped(run.sequence) + "</span>") +
            "</summary>\n" + run_section(run) + "</details>\n";
  }
  return html + "</section>\n";
}

}  // namespace rilo
