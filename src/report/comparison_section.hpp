// The parts of the page that compare runs.
#pragma once

#include <string>
#include <vector>

#include "report/run_report.hpp"

namespace rilo {

/// With several sequences an overview of all; then, sequence by sequence, table and charts.
std::string comparison_sections(const std::vector<RunReport>& runs);

/// Each run's own section, folded. The charts of comparison_sections draw from the data in them.
std::string folded_runs(const std::vector<RunReport>& runs);

}  // namespace rilo
