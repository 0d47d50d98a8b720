// The figures of a run.
#pragma once

#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

RunMetrics run_metrics(const RunRecord& run);

/// Points without times were tried before the run.
bool was_tried(const SessionResult& run);
TrialMetrics trial_metrics(const CompensationTrial& trial);
/// "40 of 40 sweeps fit better with the times of the points' order: taken as raw".
std::string trial_outcome(const CompensationTrial& trial);

/// The few lines that a person reads at the end of a run.
std::string run_summary(const RunMetrics& metrics);

EvaluationMetrics evaluation_metrics(const Evaluation& evaluation);
EvaluationMetrics evaluation_metrics(const Evaluation& evaluation, const TruthMatch& truth);

}  // namespace rilo
