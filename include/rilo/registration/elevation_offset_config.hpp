#pragma once

namespace rilo {

/// Constant error of the sensor's elevation angles, found from the sweeps alone.
struct ElevationOffsetConfig {
  bool enabled = true;        ///< estimate it, and correct it once it is certain
  double initial_deg = 0.0;   ///< what was found before: added from the first sweep on
  double significance = 3.0;  ///< certain when so many standard deviations from 0 or initial_deg
  double least_deg = 0.08;    ///< smaller errors of it are not corrected
  double step_deg = 0.03;     ///< the correction moves by at most this from sweep to sweep
};

}  // namespace rilo
