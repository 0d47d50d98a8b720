// The figures of a run.
#pragma once

#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

RunMetrics run_metrics(const RunRecord& run);

/// Points without times were tried before the run.
bool was_tried(const SessionResult& run);
TrialMetrics trial_metrics(const CompensationTrial& trial);
/// ", 38 lie on the cones of the beams"; empty where the cones say nothing.
std::string cones_text(std::size_t on_cones, std::size_t off_cones);
/// "40 of 40 sweeps fit better with the times of the points' order, 38 lie on the cones of the beams: taken as raw".
std::string trial_outcome(const CompensationTrial& trial);

/// The few lines that a person reads at the end of a run.
std::string run_summary(const RunMetrics& metrics);

EvaluationMetrics evaluation_metrics(const Evaluation& evaluation);
EvaluationMetrics evaluation_metrics(const Evaluation& evaluation, const TruthMatch& truth);

}  // namespace rilo
