// Tables of figures with the best of each column marked.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/experiment_report.hpp"

namespace rilo {

/// A row: its head, and a value for each column.
struct FigureRow {
  std::string head_html;  ///< escaped already
  std::vector<std::optional<double>> values;
  std::string last_html;  ///< text of the last column, escaped already
};

/// HTML of the table; a column without any value is omitted, the smallest value of a column of several is bold, but
/// for the first `unranked` columns. `last` is the heading of the text column; empty: none.
std::string figure_table(const std::string& corner, const std::vector<ExperimentFigure>& columns,
                         const std::vector<FigureRow>& rows, const std::string& last = "", std::size_t unranked = 0);

}  // namespace rilo
