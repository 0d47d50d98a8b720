// Absolute pose error: how far the estimate is from the truth, pose by pose.
#pragma once

#include <vector>

#include "rilo/evaluation/alignment.hpp"
#include "rilo/evaluation/error_summary.hpp"

namespace rilo {

/// Absolute errors of one trajectory.
struct AbsolutePoseError {
  Alignment alignment = Alignment::kUmeyama;
  SE3 T_truth_estimate = SE3::Identity();  ///< motion applied to the estimate
  ErrorSummary translation_m;
  ErrorSummary rotation_deg;
};

/// APE (also ATE; Sturm et al., IROS 2012): distance of positions and angle between orientations after `alignment`.
/// Same figures as `evo_ape --align` (translation part, angle part) for Alignment::kUmeyama.
/// @throws std::invalid_argument as check_trajectories.
AbsolutePoseError absolute_pose_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                                      Alignment alignment);

}  // namespace rilo
