#pragma once

namespace rilo {

/// Point-to-plane registration of the source cloud to the local map (III-D).
struct AdaptiveIcpConfig {
  bool adaptive = true;                 ///< false: ablation B, unit weights within the gate of the initial threshold
  int max_iterations = 30;
  double damping = 1e-6;                ///< λ, relative to the largest diagonal element
  double rotation_epsilon_rad = 1e-5;   ///< converged when an update turns less …
  double translation_epsilon_m = 1e-4;  ///< … and moves less
  double gate = 3.0;                    ///< residuals beyond gate · σ_th are no correspondences
  bool refine_motion = true;            ///< estimate the velocity during the sweep together with the pose
  bool motion_prior = true;             ///< hold directions that the sweep does not constrain to the predicted motion
  double acceleration_m_s2 = 3.0;       ///< expected change of velocity per second: strength of the motion prior
  double angular_acceleration_rad_s2 = 2.0;
  double noise_m = 0.02;                ///< least standard deviation of a residual
  double information_scale = 0.05;      ///< share of the residuals that count as independent
};

}  // namespace rilo
