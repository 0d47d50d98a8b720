#pragma once

#include <cstdint>

namespace rilo {

/// Rule that chooses between prediction and coarse result (III-B).
enum class InitialPoseRule : std::uint8_t {
  kFixedTau,   ///< the paper's: coarse result if within tau of the prediction
  kMapScore,   ///< the candidate that explains the local map better
};

struct InitialPoseConfig {
  InitialPoseRule rule = InitialPoseRule::kMapScore;
  double tau_m = 1.5;   ///< τ of the paper's rule
};

}  // namespace rilo
