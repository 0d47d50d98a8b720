#include "calibration/sensor_calibration.hpp"

#include "registration/plane_residuals.hpp"

namespace rilo {

void SensorCalibration::learn(const PreparedSweep& prepared, const IcpResult& icp, double sigma_th_m,
                              const AdaptiveIcpConfig& config, bool sound, LocalMap& map) {
  if (elevation_config_.enabled) {
    const ElevationInformation sweep =
        elevation_information(prepared.source, map, icp, sigma_th_m, config, pose_by_elevation_, kSampleStride);
    pose_by_elevation_ = sweep.pose;
    if (sound) {
      elevation_.add(sweep);
      const double change_rad = elevation_.advance();
      if (change_rad != 0.0) {
        map.shift_elevation(change_rad, pose_by_elevation_);
      }
    }
  }
  if (beams_config_.enabled && sound) {
    beams_.learn(prepared.beam_sample, map, icp, sigma_th_m, config);
  }
}

void SensorCalibration::apply_to(Preprocessor& preprocessor) const {
  preprocessor.track_beams(beams_config_.enabled);
  preprocessor.set_elevation_offset(elevation_.applied_rad());
  preprocessor.set_beam_angles(beams_.angles());
}

}  // namespace rilo
