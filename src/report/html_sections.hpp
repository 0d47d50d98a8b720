// The parts of the page about one run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/run_report.hpp"

namespace rilo {

/// One run from its title to its facts.
std::string run_section(const RunReport& run);

/// The title, or a plain one when it is empty; escaped.
std::string title_of(const RunReport& run);

/// A box of the page: heading, a line that says what is seen, and a chart that the script draws.
std::string chart_panel(const char* chart, const char* size, const char* heading, const char* caption);

/// A table of names and values; empty without any.
std::string facts_panel(const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace rilo
