#include <fmt/format.h>

#include "experiment_table.hpp"
#include "figure_table.hpp"
#include "html_sections.hpp"
#include "html_text.hpp"

namespace rilo {

namespace {

using Json = nlohmann::json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// Figures that any cell has.
std::vector<ExperimentFigure> figures_there(const ExperimentReport& experiment) {
  std::vector<ExperimentFigure> figures;
  for (const ExperimentFigure& figure : experiment.figures) {
    if (ExperimentTable(experiment, figure.key).any()) figures.push_back(figure);
  }
  return figures;
}

Json figure_data(const ExperimentReport& experiment, const ExperimentFigure& figure) {
  const ExperimentTable table(experiment, figure.key);
  Json values = Json::array();
  for (std::size_t s = 0; s < table.sequences().size(); ++s) {
    Json row = Json::array();
    for (std::size_t k = 0; k < table.configurations().size(); ++k) row.push_back(or_null(table.at(s, k)));
    values.push_back(row);
  }
  Json means = Json::array();
  for (std::size_t k = 0; k < table.configurations().size(); ++k) means.push_back(or_null(table.mean(k)));
  return {{"title", figure.title}, {"unit", figure.unit}, {"digits", figure.digits},
          {"values", values},      {"means", means},      {"common", table.common_sequences()}};
}

Json experiment_data(const ExperimentReport& experiment, const std::vector<ExperimentFigure>& figures) {
  const ExperimentTable names(experiment, "");
  Json data{{"sequences", names.sequences()},
            {"configurations", names.configurations()},
            {"figures", Json::array()},
            {"sensitivities", Json::array()}};
  for (const ExperimentFigure& figure : figures) data["figures"].push_back(figure_data(experiment, figure));
  for (const SensitivitySeries& series : experiment.sensitivities) {
    data["sensitivities"].push_back({{"key", series.key}, {"points", series.points}, {"base", series.base}});
  }
  return data;
}

std::string means_panel(const ExperimentReport& experiment, const std::vector<ExperimentFigure>& figures) {
  std::vector<FigureRow> rows;
  bool any = false;
  for (const ExperimentFigure& figure : figures) {
    const ExperimentTable table(experiment, figure.key);
    for (std::size_t k = 0; k < table.configurations().size(); ++k) {
      if (rows.size() <= k) rows.push_back({escaped(table.configurations()[k]), {}, ""});
      rows[k].values.push_back(table.mean(k));
      any = any || table.mean(k);
    }
  }
  const ExperimentTable first(experiment, figures.front().key);
  if (!any) {
    return "<section class=\"panel full\"><h3>Mean of the sequences</h3><p>None: no sequence has figures of every "
           "configuration.</p></section>\n";
  }
  return fmt::format(
             "<section class=\"panel full\"><h3>Mean of the sequences</h3><p class=\"caption\">Over the sequences for "
             "which every configuration has the figure ({}: {} of {}); the best of each column is bold.</p>",
             escaped(figures.front().title), first.common_sequences(), first.sequences().size()) +
         figure_table("configuration", figures, rows) + "</section>\n";
}

std::string sequence_tables(const ExperimentReport& experiment, const std::vector<ExperimentFigure>& figures) {
  std::string html =
      "<section class=\"panel full\"><details><summary>All figures by sequence and configuration</summary>\n";
  for (const ExperimentFigure& figure : figures) {
    const ExperimentTable table(experiment, figure.key);
    std::vector<ExperimentFigure> columns;
    for (const std::string& sequence : table.sequences()) columns.push_back({"", sequence, "", figure.digits});
    std::vector<FigureRow> rows;
    for (std::size_t k = 0; k < table.configurations().size(); ++k) {
      FigureRow row{escaped(table.configurations()[k]), {}, ""};
      for (std::size_t s = 0; s < table.sequences().size(); ++s) row.values.push_back(table.at(s, k));
      rows.push_back(row);
    }
    html += fmt::format("<h3>{}{}</h3>", escaped(figure.title), figure.unit.empty() ? "" : ", " + escaped(figure.unit));
    html += figure_table("configuration", columns, rows);
  }
  return html + "</details></section>\n";
}

std::string failures(const ExperimentReport& experiment) {
  std::string rows;
  for (const ExperimentCell& cell : experiment.cells) {
    if (!cell.error.empty()) {
      rows += "<tr><th scope=\"row\">" + escaped(cell.sequence) + "</th><td>" + escaped(cell.configuration) +
              "</td><td>" + escaped(cell.error) + "</td></tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<section class=\"panel full\"><h3>Failed</h3><div class=\"scroll\" tabindex=\"0\"><table><thead><tr>"
         "<th scope=\"col\">sequence</th><th scope=\"col\">configuration</th><th scope=\"col\">why</th></tr></thead>"
         "<tbody>\n" +
         rows + "</tbody></table></div></section>\n";
}

}  // namespace

std::string experiment_section(const ExperimentReport& experiment) {
  const std::vector<ExperimentFigure> figures = figures_there(experiment);
  std::string html = "<article class=\"experiment\">\n<header><h2>" + escaped(experiment.title) + "</h2>\n";
  html += experiment.notice.empty() ? "" : "<p class=\"notice\">" + escaped(experiment.notice) + "</p>\n";
  html += "</header>\n<div class=\"grid\">\n";
  if (figures.empty()) {
    html += "<section class=\"panel full\"><p>No cell has any figure.</p></section>\n";
  } else {
    html += means_panel(experiment, figures) +
            chart_panel("cells", "full", "By sequence", "Shorter is better; each sequence has its own scale.");
    if (!experiment.sensitivities.empty()) {
      html += chart_panel("sensitivity", "full", "Sensitivity",
                          "Change of the figure when one key alone is changed: thin lines are sequences, the thick one "
                          "their mean (geometric).");
    }
    html += sequence_tables(experiment, figures);
  }
  html += failures(experiment) + facts_panel(experiment.facts) + "</div>\n";
  return html + embedded_json(experiment_data(experiment, figures)) + "</article>\n";
}

}  // namespace rilo
