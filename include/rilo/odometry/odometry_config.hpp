// The whole configuration: one plain struct per stage.
#pragma once

#include <cstdint>

#include "rilo/stage_config.hpp"

namespace rilo {

/// Motion prediction from up to three past poses (III-B).
struct MotionPredictionConfig {
  bool enabled = true;  ///< false: the last pose is the prediction
  /// σ_th at which w_r, the weight of the newest increment, is 3/4; it is 1/2 at σ_th = 0 and 1 at infinity.
  double recent_half_sigma_m = 0.5;
};

/// Prior of the registration from the motion so far (white noise on acceleration).
struct MotionPriorConfig {
  bool enabled = true;                       ///< false: the sweep alone decides, as in the paper
  bool learn = true;                         ///< a larger angular acceleration is learnt from the drive
  double acceleration_m_s2 = 10.0;           ///< standard deviation of the change of velocity in 0.1 s, per second
  double angular_acceleration_rad_s2 = 2.0;  ///< the same of the turn rate, the least
  double unseen_share = 0.2;                 ///< factor on both after a degenerate sweep
};

/// Rule that chooses between prediction and coarse result (III-B).
enum class InitialPoseRule : std::uint8_t {
  kFixedTau,  ///< the paper's: coarse result if within τ of the prediction
  kMapScore,  ///< the candidate that explains the local map better
};

/// Selection of the initial pose.
struct InitialPoseConfig {
  InitialPoseRule rule = InitialPoseRule::kMapScore;
  double tau_m = 1.5;           ///< τ of the paper's rule
  double score_sigma_m = 0.2;   ///< tolerance of the map score
  int score_points = 600;       ///< points that the score uses
  double alarm = 0.7;           ///< the prediction is in doubt when its score is below this share of the usual score
  double margin = 0.03;         ///< share by which the coarse score must exceed the prediction's
  bool restarts = true;         ///< in doubt, start the coarse stage also from poses found by a search on the map
  double search_shift_m = 4.0;  ///< radius of that search in x and y
  double search_yaw_rad = 0.6;  ///< half width of that search in yaw
};

/// Adaptive threshold σ_th (III-C).
struct AdaptiveThresholdConfig {
  double initial_m = 0.3;  ///< σ_th before any error is known
  double floor_m = 0.03;
  double ceiling_m = 2.0;
  double narrowing = 4.0;         ///< a registration goes on with σ_th over this until it is floor_m; 1: off
  double decay = 1.5;             ///< σ_decay of the motion weight γ
  double rotation_scale_m = 1.0;  ///< σ_max: largest share of the rotation in the error
  double rotation_gain = 2.0;     ///< β of tanh(β θ), 1/rad
  double forgetting = 0.95;       ///< weight of the past per sweep; 1: the paper's mean over all sweeps
};

/// When a pose is degenerate, poorly supported or lost.
struct HealthConfig {
  double lost_share = 0.5;           ///< lost when the map score falls below this share of the usual one
  double least_score = 0.1;          ///< second and third sweep of a map: lost below it, as wrong ones are
  double degenerate_ratio = 0.0045;  ///< a relative eigenvalue below it means a direction is not constrained
  int restart_after = 10;  ///< sweeps lost or missing in a row, three of them lost, after which a new map starts
};

/// Limits of the motion of a sensor, on a vehicle or in a hand. A registration beyond them is lost.
struct MotionBoundsConfig {
  double max_speed_m_s = 60.0;
  double max_acceleration_m_s2 = 30.0;  ///< a braking car has 10, an arm that jerks a sensor up to 30
  double max_turn_rate_rad_s = 10.0;
  double max_angular_acceleration_rad_s2 = 50.0;
};

/// Time budget per sweep.
struct TimeBudgetConfig {
  double sweep_ms = 0.0;  ///< from the sweep to its pose, map included; 0: no limit
};

/// Complete configuration of the odometry. The defaults are meant for every sensor.
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
