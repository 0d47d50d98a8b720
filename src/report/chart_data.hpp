// What the script in the page draws from.
#pragma once

#include <string>

#include "report/run_report.hpp"

namespace rilo {

/// A <script> element with JSON: columns of numbers, rounded to what a picture can show.
std::string chart_data(const RunReport& run);

}  // namespace rilo
