#pragma once

namespace rilo {

/// When a pose is called degenerate, poorly supported or lost.
struct HealthConfig {
  double lost_share = 0.65;         ///< lost when the map score falls below this share of the usual one
  double least_score = 0.02;        ///< lost below it, whatever is usual
  double few_inlier_ratio = 0.1;    ///< fewer correspondences than this share of the source are few
  double degenerate_ratio = 0.006;  ///< a relative eigenvalue below it means a direction is not constrained
  int restart_after = 10;           ///< lost for that many sweeps in a row, a new map starts at the predicted pose
};

}  // namespace rilo
