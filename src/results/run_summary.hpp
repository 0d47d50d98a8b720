// The few lines that a person reads at the end of a run.
#pragma once

#include <string>

#include "results/metrics.hpp"

namespace rilo {

std::string run_summary(const RunMetrics& metrics);

}  // namespace rilo
