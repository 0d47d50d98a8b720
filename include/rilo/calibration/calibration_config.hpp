// Configuration of what the odometry learns about the sensor.
#pragma once

namespace rilo {

/// Constant error of the sensor's elevation angles, estimated from the sweeps alone.
struct ElevationOffsetConfig {
  bool enabled = true;        ///< estimate it, and correct it once it is significant
  double initial_deg = 0.0;   ///< known offset: added from the first sweep on
  double significance = 2.0;  ///< standard deviations from 0 or initial_deg that are significant
  double least_deg = 0.08;    ///< smaller errors are not corrected
  double step_deg = 0.03;     ///< largest change of the correction from sweep to sweep
};

/// Errors of the angles of single beams against their neighbours, estimated from the sweeps alone.
struct BeamCalibrationConfig {
  bool enabled = true;  ///< estimate and correct them
  double gain = 0.015;  ///< update gain per sweep
};

}  // namespace rilo
