// The parts of the page.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/experiment_report.hpp"
#include "report/run_report.hpp"

namespace rilo {

/// One run from its title to its facts.
std::string run_section(const RunReport& run);

/// A <script> element with the JSON that the charts of a run draw from: columns of numbers, rounded to what a picture
/// can show.
std::string chart_data(const RunReport& run);

/// Comparison of runs: with several sequences an overview of all; then, sequence by sequence, table and charts.
std::string comparison_sections(const std::vector<RunReport>& runs);

/// Each run's own section, folded. The charts of comparison_sections draw from the data in them.
std::string folded_runs(const std::vector<RunReport>& runs);

/// One experiment: bars by sequence, sensitivity, tables, failures.
std::string experiment_section(const ExperimentReport& experiment);

/// The title, or a plain one when it is empty; escaped.
std::string title_of(const RunReport& run);

/// A box of the page: heading, a line that says what is seen, and a chart that the script draws.
std::string chart_panel(const char* chart, const char* size, const char* heading, const char* caption);

/// A table of names and values; empty without any.
std::string facts_panel(const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace rilo
