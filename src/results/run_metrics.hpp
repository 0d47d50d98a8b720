// The figures of a run.
#pragma once

#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

RunMetrics run_metrics(const RunRecord& run);

EvaluationMetrics evaluation_metrics(const Evaluation& evaluation);
EvaluationMetrics evaluation_metrics(const Evaluation& evaluation, const TruthMatch& truth);

}  // namespace rilo
