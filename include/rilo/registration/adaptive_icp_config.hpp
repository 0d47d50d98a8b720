#pragma once

namespace rilo {

/// Point-to-plane registration of the source cloud to the local map (III-D).
struct AdaptiveIcpConfig {
  bool adaptive = true;       ///< false: ablation B, unit weights within a fixed gate instead of weights from σ_th
  double fixed_gate_m = 0.5;  ///< residuals beyond it are no correspondences when adaptive is off
  double gate = 3.0;          ///< residuals beyond gate · σ_th are no correspondences
  int max_iterations = 24;
  int coarse_stride = 4;                ///< every n-th point until it converges, then all points
  double damping = 1e-9;                ///< λ, relative to the largest diagonal element
  double rotation_epsilon_rad = 1e-5;   ///< converged when an update turns less …
  double translation_epsilon_m = 1e-4;  ///< … and moves less
  bool refine_motion = true;            ///< estimate the velocity during the sweep together with the pose
  double noise_m = 0.02;                ///< least standard deviation of a residual
  double scatter_noise_m = 0.01;        ///< σ of the weight σ² / (σ² + variance) of points that meet no plane
  double independent_share = 0.01;      ///< share of the residuals that count as independent in the information
  double weak_direction = 0.004;        ///< relative eigenvalue at which half a direction is left to the prior; 0: off
};

}  // namespace rilo
