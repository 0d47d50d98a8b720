#pragma once

#include <cstdint>

namespace rilo {

/// Rule that chooses between prediction and coarse result (III-B).
enum class InitialPoseRule : std::uint8_t {
  kFixedTau,  ///< the paper's: coarse result if within τ of the prediction
  kMapScore,  ///< the candidate that explains the local map better
};

/// Selection of the initial pose.
struct InitialPoseConfig {
  InitialPoseRule rule = InitialPoseRule::kMapScore;
  double tau_m = 1.5;           ///< τ of the paper's rule
  double score_sigma_m = 0.2;   ///< tolerance of the map score
  int score_points = 600;       ///< points that the score looks at
  double alarm = 0.7;           ///< the prediction is in doubt when its score is below this share of the usual score
  double margin = 0.03;         ///< by what share the coarse result's score must beat the prediction's
  bool restarts = true;         ///< in doubt, start the coarse stage also from poses found by a search on the map
  double search_shift_m = 4.0;  ///< half width of that search along x and y
  double search_yaw_rad = 0.6;  ///< half width of that search in yaw
};

}  // namespace rilo
