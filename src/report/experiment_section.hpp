// The part of the page about one experiment.
#pragma once

#include <string>

#include "report/experiment_report.hpp"

namespace rilo {

/// Bars by sequence, sensitivity, tables, failures.
std::string experiment_section(const ExperimentReport& experiment);

}  // namespace rilo
