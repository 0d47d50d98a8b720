#include "calibration/sensor_calibration.hpp"

#include <utility>

#include "geometry/degrees.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

void SensorCalibration::learn(const PreparedSweep& prepared, const IcpResult& icp, double sigma_th_m,
                              const AdaptiveIcpConfig& config, bool settled, const LocalMap& map) {
  if (elevation_config_.enabled) {
    const ElevationInformation sweep =
        elevation_information(prepared.source, map, icp, sigma_th_m, config, pose_by_elevation_, kSampleStride);
    pose_by_elevation_ = sweep.pose;
    if (settled) {
      elevation_.add(sweep);
      change_rad_ = elevation_.advance();
    }
  }
  if (beams_config_.enabled && settled) {
    beams_.learn(prepared.beam_sample, map, icp, sigma_th_m, config);
  }
}

void SensorCalibration::move(LocalMap& map) {
  if (change_rad_ != 0.0) {
    map.shift_elevation(std::exchange(change_rad_, 0.0), pose_by_elevation_);
  }
}

SensorAngles SensorCalibration::angles() const {
  return {kRadPerDeg * elevation_.known_deg(), elevation_.estimate(), beams_.corrections(elevation_.applied_rad())};
}

void SensorCalibration::begin_with(const SensorAngles& known) {
  begin_with(kDegPerRad * known.elevation_offset_rad, known.elevation_estimate, known.beams);
}

void SensorCalibration::begin_with(double elevation_deg, const AngleEstimate& others,
                                   const std::vector<BeamCorrection>& beams) {
  elevation_.begin_with(elevation_deg, others);
  if (beams_config_.enabled) {
    beams_.begin_with(beams, elevation_.applied_rad());
  }
  pose_by_elevation_ = {};
  change_rad_ = 0.0;
}

void SensorCalibration::apply_to(Preprocessor& preprocessor) const {
  preprocessor.track_beams(beams_config_.enabled);
  preprocessor.set_elevation_offset(elevation_.applied_rad());
  preprocessor.set_beam_angles(beams_.angles());
}

}  // namespace rilo
