#pragma once

namespace rilo {

/// Errors of the angles of single beams against their neighbours, found from the sweeps alone.
struct BeamCalibrationConfig {
  bool enabled = true;  ///< find and correct them
  double gain = 0.015;  ///< share of what a sweep shows that is corrected at once
};

}  // namespace rilo
