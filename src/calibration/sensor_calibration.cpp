#include "calibration/sensor_calibration.hpp"

#include <utility>

#include "registration/plane_residuals.hpp"

namespace rilo {

void SensorCalibration::learn(const PreparedSweep& prepared, const IcpResult& icp, double sigma_th_m,
                              const AdaptiveIcpConfig& config, bool sound, const LocalMap& map) {
  if (elevation_config_.enabled) {
    const ElevationInformation sweep =
        elevation_information(prepared.source, map, icp, sigma_th_m, config, pose_by_elevation_, kSampleStride);
    pose_by_elevation_ = sweep.pose;
    if (sound) {
      elevation_.add(sweep);
      change_rad_ = elevation_.advance();
    }
  }
  if (beams_config_.enabled && sound) {
    beams_.learn(prepared.beam_sample, map, icp, sigma_th_m, config);
  }
}

void SensorCalibration::move(LocalMap& map) {
  if (change_rad_ != 0.0) {
    map.shift_elevation(std::exchange(change_rad_, 0.0), pose_by_elevation_);
  }
}

void SensorCalibration::start_over() {
  elevation_.start_over();
  beams_.start_over();
  pose_by_elevation_ = {};
  change_rad_ = 0.0;
}

void SensorCalibration::apply_to(Preprocessor& preprocessor) const {
  preprocessor.track_beams(beams_config_.enabled);
  preprocessor.set_elevation_offset(elevation_.applied_rad());
  preprocessor.set_beam_angles(beams_.angles());
}

}  // namespace rilo
