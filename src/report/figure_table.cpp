#include "figure_table.hpp"

#include <algorithm>
#include <cstddef>

#include "html_text.hpp"

namespace rilo {

namespace {

/// What a reader sees decides: values that print alike are equally good.
struct Column {
  bool any = false;
  std::string best;  ///< printed; empty: nothing to mark
};

Column column_of(const std::vector<FigureRow>& rows, std::size_t i, int digits) {
  Column column;
  std::optional<double> least;
  std::optional<double> most;
  std::size_t count = 0;
  for (const FigureRow& row : rows) {
    if (row.values[i]) {
      ++count;
      least = std::min(least.value_or(*row.values[i]), *row.values[i]);
      most = std::max(most.value_or(*row.values[i]), *row.values[i]);
    }
  }
  column.any = count > 0;
  column.best = count > 1 && number(least, digits) != number(most, digits) ? number(least, digits) : "";
  return column;
}

}  // namespace

std::string figure_table(const std::string& corner, const std::vector<ExperimentFigure>& columns,
                         const std::vector<FigureRow>& rows, const std::string& last, std::size_t unranked) {
  std::vector<Column> shown;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    shown.push_back(column_of(rows, i, columns[i].digits));
    if (i < unranked) shown.back().best.clear();
  }
  std::string html =
      "<div class=\"scroll\" tabindex=\"0\"><table class=\"numbers\"><thead><tr><th scope=\"col\">" + corner + "</th>";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    html += !shown[i].any ? ""
                          : "<th scope=\"col\">" + escaped(columns[i].title) + " <span class=\"unit\">" +
                                escaped(columns[i].unit) + "</span></th>";
  }
  html += last.empty() ? "" : "<th scope=\"col\" class=\"text\">" + last + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const FigureRow& row : rows) {
    html += "<tr><th scope=\"row\">" + row.head_html + "</th>";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string text = number(row.values[i], columns[i].digits);
      const bool best = row.values[i] && text == shown[i].best;
      html += !shown[i].any ? ""
              : best        ? "<td class=\"best\"><strong>" + text + "</strong></td>"
                            : "<td>" + text + "</td>";
    }
    html += last.empty() ? "" : "<td class=\"text\">" + row.last_html + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>";
}

}  // namespace rilo
