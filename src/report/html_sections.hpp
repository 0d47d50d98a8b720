// The parts of the page.
#pragma once

#include <string>
#include <vector>

#include "rilo/report/run_report.hpp"

namespace rilo {

/// One run from its title to its facts.
std::string run_section(const RunReport& run);

/// Table of the headline figures of several runs.
std::string comparison_section(const std::vector<RunReport>& runs);

/// The title, or a plain one when it is empty; escaped.
std::string title_of(const RunReport& run);

}  // namespace rilo
