// The figures of a run.
#pragma once

#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

RunMetrics run_metrics(const RunRecord& run);

/// The few lines that a person reads at the end of a run.
std::string run_summary(const RunMetrics& metrics);

EvaluationMetrics evaluation_metrics(const Evaluation& evaluation);
EvaluationMetrics evaluation_metrics(const Evaluation& evaluation, const TruthMatch& truth);

}  // namespace rilo
