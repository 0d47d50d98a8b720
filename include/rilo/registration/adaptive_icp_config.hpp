#pragma once

namespace rilo {

/// Point-to-plane registration of the source cloud to the local map (III-D).
struct AdaptiveIcpConfig {
  bool adaptive = true;                 ///< false: ablation B, unit weights within a fixed gate
  int max_iterations = 30;
  double damping = 1e-6;                ///< λ, relative to the largest diagonal element
  double rotation_epsilon_rad = 1e-5;   ///< converged when an update turns less …
  double translation_epsilon_m = 1e-4;  ///< … and moves less
};

}  // namespace rilo
