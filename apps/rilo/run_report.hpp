// The HTML report of a run.
#pragma once

#include <nlohmann/json.hpp>

#include "rilo/report/run_report.hpp"
#include "run_record.hpp"

namespace rilo::cli {

/// What report.html shows; figures come from `metrics`, so that they agree.
RunReport report_of(const RunRecord& run, const nlohmann::json& metrics);

}  // namespace rilo::cli
