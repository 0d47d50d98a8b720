// One self-contained HTML file about one run, several, or experiments.
#pragma once

#include <string>
#include <vector>

#include "report/experiment_report.hpp"
#include "report/run_report.hpp"

namespace rilo {

/// Content of one page. Runs are compared sequence by sequence, in the order in which they come; with several
/// sequences there is an overview of all of them.
struct ReportPage {
  std::string title;                 ///< empty: made from the contents
  std::vector<std::string> notices;  ///< on top: what is missing and why
  std::vector<RunReport> runs;
  std::vector<ExperimentReport> experiments;
};

/// A complete HTML page: no network, no other file, light and dark, for screen and print. A single run is shown as it
/// is; several are compared, and each one's own page is folded below.
/// @throws std::invalid_argument when there is neither a run nor an experiment, when a run's `sweeps` is neither empty
/// nor as long as `estimate`, or a pose is not finite.
std::string html_report(const ReportPage& page);

}  // namespace rilo
