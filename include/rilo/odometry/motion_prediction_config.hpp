#pragma once

namespace rilo {

/// Motion prediction from up to three past poses (III-B).
struct MotionPredictionConfig {
  bool enabled = true;  ///< false: the last pose is the prediction
  double recent_half_sigma_m =
      0.5;  ///< σ_th at which the newest increment weighs 3/4 (it weighs 1/2 at σ_th = 0, 1 at infinity)
};

}  // namespace rilo
