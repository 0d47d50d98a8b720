// One self-contained HTML file about one run or several.
#pragma once

#include <iosfwd>
#include <vector>

#include "rilo/report/run_report.hpp"

namespace rilo {

/// Writes a complete HTML page: no network, no other file, light and dark. The caller checks the stream.
/// @throws std::invalid_argument when `sweeps` is neither empty nor as long as `estimate`, or a pose is not finite.
void write_html_report(const RunReport& run, std::ostream& out);

/// The same with several runs: a table that compares their figures, then each run. @throws as above, or for no run.
void write_html_report(const std::vector<RunReport>& runs, std::ostream& out);

}  // namespace rilo
