#pragma once

namespace rilo {

/// Adaptive threshold σ_th (III-C).
struct AdaptiveThresholdConfig {
  double initial_m = 0.3;  ///< σ_th before any error is known
  double floor_m = 0.05;
  double ceiling_m = 2.0;
  double decay = 1.5;             ///< σ_decay of the motion weight γ
  double rotation_scale_m = 1.0;  ///< σ_max: largest share of the rotation in the error
  double rotation_gain = 2.0;     ///< β of tanh(β θ), 1/rad
  double forgetting = 0.95;       ///< weight of the past per sweep; 1: the paper's mean over all sweeps
};

}  // namespace rilo
