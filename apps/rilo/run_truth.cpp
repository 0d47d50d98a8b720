// Ground truth of a run.
#include <stdexcept>
#include <utility>

#include "rilo/io/ground_truth.hpp"
#include "rilo/io/io_error.hpp"
#include "run_record.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

TruthInstant same_instant(PoseInstant instant) {
  switch (instant) {
    case PoseInstant::kStart:
      return TruthInstant::kStart;
    case PoseInstant::kEnd:
      return TruthInstant::kEnd;
    case PoseInstant::kMid:
      break;
  }
  return TruthInstant::kMid;
}

TruthMatch match(const RunRecord& run, const GroundTruth& truth) {
  TruthMatch match;
  match.file = truth.file.string();
  match.instant = truth.instant;
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    if (run.indices[i] < truth.T_world_lidar.size()) {
      match.truth.push_back(truth.T_world_lidar[run.indices[i]]);
      match.estimate.push_back(run.results[i].T_odom_lidar);
    }
  }
  return match;
}

}  // namespace

void evaluate_run(RunRecord& run) {
  try {
    const auto truth = read_ground_truth(run.data, same_instant(run.pose_instant));
    if (!truth) return;
    TruthMatch matched = match(run, *truth);
    run.source.warnings.insert(run.source.warnings.end(), truth->warnings.begin(), truth->warnings.end());
    if (matched.truth.size() < 2) {
      run.truth_error = matched.file + ": fewer than two of the sweeps that were run have a true pose";
      return;
    }
    run.evaluation = evaluate(matched.truth, matched.estimate);
    run.truth = std::move(matched);
  } catch (const IoError& error) {
    run.truth_error = error.what();
  } catch (const std::invalid_argument& error) {
    run.truth_error = error.what();
  }
  if (!run.truth_error.empty()) run.source.warnings.push_back("ground truth left out: " + run.truth_error);
}

}  // namespace rilo::cli
