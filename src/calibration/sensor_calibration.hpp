// What the odometry learns about its sensor: a constant elevation offset, and the angles of single beams.
#pragma once

#include <vector>

#include "calibration/beam_calibration.hpp"
#include "calibration/elevation_offset.hpp"
#include "cloud/preprocess.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/calibration/sensor_angles.hpp"

namespace rilo {

/// Both calibrations. They learn from registered sweeps; what they find corrects the points of the next one.
class SensorCalibration {
 public:
  SensorCalibration(const ElevationOffsetConfig& elevation, const BeamCalibrationConfig& beams)
      : elevation_config_(elevation), beams_config_(beams), elevation_(elevation), beams_(beams) {}

  /// Learns from a sweep beyond doubt that was registered to `map` with `config`, weighted with `sigma_th_m`, before it
  /// goes into the map. Unless the map is `settled`, only the pose derivative is followed.
  void learn(const PreparedSweep& prepared, const IcpResult& icp, double sigma_th_m, const AdaptiveIcpConfig& config,
             bool settled, const LocalMap& map);

  /// Moves the map by what learn() changed of the applied elevation offset: after the sweep, whose points still have
  /// the old one, went in.
  void move(LocalMap& map);

  /// Derivative of the last pose with respect to the elevation offset: LocalMap::insert keeps it with the points.
  const PoseDerivative& pose_by_elevation() const { return pose_by_elevation_; }

  /// Hands the corrections to the preprocessing of the next sweep.
  void apply_to(Preprocessor& preprocessor) const;

  const ElevationOffsetEstimator& elevation() const { return elevation_; }
  const BeamCalibration& beams() const { return beams_; }

  /// Back to the configuration.
  void reset() { *this = SensorCalibration(elevation_config_, beams_config_); }

  /// What is known by now: of the elevation offset, what is certain.
  SensorAngles angles() const;

  /// Begins anew with `known` in place of the configured elevation offset.
  void begin_with(const SensorAngles& known);

  /// Begins anew with what was found, for another pass over the sweeps.
  void start_over() {
    begin_with(elevation_.known_deg(), elevation_.others(), beams_.corrections(elevation_.applied_rad()));
  }

 private:
  void begin_with(double elevation_deg, const AngleEstimate& others, const std::vector<BeamCorrection>& beams);

  ElevationOffsetConfig elevation_config_;
  BeamCalibrationConfig beams_config_;
  ElevationOffsetEstimator elevation_;
  BeamCalibration beams_;
  PoseDerivative pose_by_elevation_;
  double change_rad_ = 0;  // of the applied elevation offset, by which the map has not been moved
};

}  // namespace rilo
