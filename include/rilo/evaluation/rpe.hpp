// Relative pose error over short stretches: how noisy the motion is.
#pragma once

#include <vector>

#include "rilo/evaluation/error_summary.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Relative errors of one trajectory.
struct RelativePoseError {
  ErrorSummary translation_m;
  ErrorSummary rotation_deg;
};

/// Error of the motion between consecutive poses (RPE with delta = 1 frame; Sturm et al., IROS 2012).
/// @throws std::invalid_argument as check_trajectories.
RelativePoseError rpe_per_frame(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

/// Error of the motion per metre of true path. Every pose starts a pair that ends at the first pose at least 1 m
/// farther along the true path; errors are divided by the length of path between the two, so that fast drives, whose
/// poses lie more than a metre apart, stay comparable. Units: m per m, degrees per m. No pair (count = 0) on paths
/// below 1 m.
/// @throws std::invalid_argument as check_trajectories.
RelativePoseError rpe_per_metre(const std::vector<SE3>& truth, const std::vector<SE3>& estimate);

}  // namespace rilo
