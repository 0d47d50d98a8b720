#pragma once

namespace rilo {

/// Constant error of the sensor's elevation angles, found from the sweeps alone.
struct ElevationOffsetConfig {
  bool enabled = true;        ///< estimate it, and correct it once it is certain
  double significance = 3.0;  ///< certain when so many standard deviations from zero
  double least_deg = 0.08;    ///< smaller errors are not corrected
  double step_deg = 0.03;     ///< the correction moves by at most this from sweep to sweep
};

}  // namespace rilo
