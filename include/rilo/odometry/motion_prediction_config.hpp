#pragma once

namespace rilo {

/// Motion prediction from up to three past poses (III-B).
struct MotionPredictionConfig {
  bool enabled = true;      ///< false: the last pose is the prediction
};

}  // namespace rilo
