// The HTML report of a run.
#pragma once

#include "report/run_report.hpp"
#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

/// What report.html shows; figures come from `metrics`, so that they agree.
RunReport report_of(const RunRecord& run, const RunMetrics& metrics);

}  // namespace rilo
