#include "rilo/evaluation/evaluation.hpp"

namespace rilo {

Evaluation evaluate(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
  Evaluation evaluation;
  evaluation.kitti = kitti_error(truth, estimate);
  evaluation.poses = truth.size();
  evaluation.path_m = path_lengths(truth).back();
  evaluation.ape = absolute_pose_error(truth, estimate, Alignment::kUmeyama);
  evaluation.ape_unaligned = absolute_pose_error(truth, estimate, Alignment::kFirstPose);
  evaluation.rpe_frame = rpe_per_frame(truth, estimate);
  evaluation.rpe_metre = rpe_per_metre(truth, estimate);
  evaluation.series = error_series(truth, estimate, Alignment::kFirstPose);
  evaluation.end_error_m = evaluation.series.back().translation_m;
  if (evaluation.path_m > 0.0) evaluation.end_error_pct = 100.0 * evaluation.end_error_m / evaluation.path_m;
  return evaluation;
}

}  // namespace rilo
