// The whole configuration: one plain struct per stage.
#pragma once

#include "rilo/cloud/preprocess_config.hpp"
#include "rilo/map/local_map_config.hpp"
#include "rilo/odometry/adaptive_threshold_config.hpp"
#include "rilo/odometry/health_config.hpp"
#include "rilo/odometry/initial_pose_config.hpp"
#include "rilo/odometry/motion_bounds_config.hpp"
#include "rilo/odometry/motion_prediction_config.hpp"
#include "rilo/odometry/motion_prior_config.hpp"
#include "rilo/odometry/time_budget_config.hpp"
#include "rilo/registration/adaptive_icp_config.hpp"
#include "rilo/registration/beam_calibration_config.hpp"
#include "rilo/registration/coarse_registration_config.hpp"
#include "rilo/registration/elevation_offset_config.hpp"

namespace rilo {

/// Everything the odometry can be told. The defaults are meant for every sensor.
struct OdometryConfig {
  int threads = 0;  ///< 0: as many as the machine has
  PreprocessConfig preprocess;
  CoarseRegistrationConfig coarse;
  MotionPredictionConfig prediction;
  MotionPriorConfig prior;
  InitialPoseConfig initial_pose;
  AdaptiveThresholdConfig threshold;
  AdaptiveIcpConfig icp;
  LocalMapConfig map;
  ElevationOffsetConfig elevation;
  BeamCalibrationConfig beams;
  HealthConfig health;
  MotionBoundsConfig bounds;
  TimeBudgetConfig budget;
};

/// Every key is in its range (odometry_keys.hpp), and those that depend on one another agree.
/// @throws std::invalid_argument naming the first value that is out of range, and the range.
void validate(const OdometryConfig& config);

/// The same configuration, if it is valid: for members that are built from it. @throws as validate.
OdometryConfig validated(const OdometryConfig& config);

}  // namespace rilo
