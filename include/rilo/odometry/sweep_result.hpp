// Result of one sweep.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// How far a pose can be trusted.
enum class OdometryStatus : std::uint8_t {
  kOk,            ///< registered
  kInitialising,  ///< first sweep: the map starts here
  kDegenerate,    ///< registered, but a direction is (nearly) unobservable; the prediction fills it
  kLost,          ///< the pose is a guess; the map is not updated
  kRecovered,     ///< registered again after kLost
  kEmpty,         ///< no usable point in the sweep; the pose is the prediction. Or the sweep before again: its pose
};
inline constexpr std::size_t kStatusCount = 6;

/// Short name for files: ok, initialising, degenerate, lost, recovered, empty.
std::string_view to_string(OdometryStatus status);

/// Why a sweep is lost; of several causes the first, but kCovered before kUnsolved.
enum class LossCause : std::uint8_t {
  kNone,
  kUnsolved,         ///< the registration had no system to solve
  kCovered,          ///< all is much nearer than in the sweep before, as under a cloth
  kOutOfTime,        ///< the time budget ended the registration while the points still moved
  kAmbiguous,        ///< it may as well lie elsewhere: along its weakest directions, on its path, where predicted
  kFitsWorse,        ///< than the sweeps before
  kFoundByChance,    ///< after a lost sweep: a search found a place that explains less of it than usual
  kFitsBeside,       ///< places a metre beside explain it about as well
  kLooseAfterGap,    ///< sweeps are missing before it, and it does not fit as closely as usual
  kNotConverged,     ///< although its matches were held
  kWeakSecondSweep,  ///< the second sweep of a map did not converge freely, or does not constrain all directions
  kLowScore,         ///< the map explains less of it than usual, or next to nothing
  kImpossibleMotion  ///< it fits where no sensor can have moved to, or with a velocity that none can have there
};
inline constexpr std::size_t kLossCauseCount = 13;
/// As in files: none, unsolved, covered, …
std::string_view to_string(LossCause cause);

/// Whether Odometry::last_map_points() of a sweep with that status belong in a map of the whole run. Not those of a
/// guess, nor, where points have times, of the first sweep: its velocity was not known, its points are smeared.
bool belongs_in_map(OdometryStatus status, bool timed);

/// Which candidate started the fine registration (III-B).
enum class InitialPoseSource : std::uint8_t { kIdentity, kPrediction, kCoarse };
/// identity, prediction, coarse.
std::string_view to_string(InitialPoseSource source);

/// The time within the sweep that a pose refers to.
enum class PoseInstant : std::uint8_t { kStart, kMid, kEnd };
/// start, mid, end.
std::string_view to_string(PoseInstant instant);

/// Why the initial pose was taken (III-B).
enum class InitialPoseReason : std::uint8_t {
  kFirstSweep,       ///< nothing to predict from
  kCoarseDisabled,   ///< only the prediction exists
  kCoarseNotNeeded,  ///< the prediction already explains the sweep: the coarse stage was not run
  kWithinTau,        ///< |t(T_pred^-1 T_align)| <= tau: coarse result taken (the paper's rule)
  kBeyondTau,        ///< farther than tau: prediction taken (the paper's rule)
  kBetterMapScore,   ///< the coarse result explains the local map better
  kWorseMapScore,    ///< the prediction explains the local map better
  kNoTime,           ///< the coarse stage would have been run, but would not have ended within the time budget
};
std::string_view to_string(InitialPoseReason reason);

/// Wall time of each stage in ms; all zero unless a clock was given to the odometry.
struct StageTimes {
  double preprocess_ms = 0;    ///< crop, NaN removal, downsampling
  double initial_pose_ms = 0;  ///< prediction, coarse registration (III-A) and selection (III-B)
  double registration_ms = 0;  ///< III-D, motion compensation of the source included
  double map_ms = 0;           ///< motion compensation of the map cloud, insertion, eviction, threshold and health
  double total_ms = 0;
};

/// Statistics of one sweep; one line of sweeps.csv.
struct SweepStats {
  std::size_t points_in = 0;        ///< as given
  std::size_t points_valid = 0;     ///< finite, within range and time, and not taken for flakes
  std::size_t points_isolated = 0;  ///< taken for flakes, and dropped: isolated returns of a sweep with many of them
  std::size_t points_map = 0;       ///< after downsampling, for the map
  std::size_t points_source = 0;    ///< source cloud S of the fine registration
  std::size_t map_voxels = 0;       ///< after the update
  InitialPoseSource initial_pose = InitialPoseSource::kIdentity;
  InitialPoseReason initial_pose_reason = InitialPoseReason::kFirstSweep;
  bool coarse_ran = false;
  int coarse_iterations = 0;
  double pred_align_distance_m = 0;  ///< Δt_i (III-B)
  double prediction_score = 0;       ///< map score of the prediction, 0 … 1
  double map_score = 0;              ///< map score of the result, 0 … 1
  int iterations = 0;                ///< fine registration (III-D)
  bool converged = false;
  std::size_t inliers = 0;                       ///< correspondences of the last iteration
  double inlier_ratio = 0;                       ///< inliers / points_source
  double residual_rms_m = 0;                     ///< weighted point-to-plane residual
  double sigma_th_m = 0;                         ///< threshold used for this sweep (III-C)
  double gamma = 1;                              ///< γ_i, steadiness of the motion (III-C)
  double deviation_m = 0;                        ///< e_i, model deviation (III-C)
  std::array<double, 6> relative_eigenvalues{};  ///< of the information matrix, ascending, largest = 1
  double elevation_offset_rad = 0;               ///< estimate of the angle missing from the sensor's elevation angles
  double elevation_offset_sigma_rad = 0;         ///< its standard deviation; infinite before there is one
  double elevation_applied_rad = 0;              ///< angle added to those of the next sweep
  double beam_elevation_rms_rad = 0;             ///< root mean square of the corrections of single beams, next sweep
  double beam_azimuth_rms_rad = 0;
  LossCause loss_cause = LossCause::kNone;  ///< of a lost sweep, also when a map begins with it
  bool impossible_motion = false;           ///< it fits the map where no sensor can have moved to in its time
  bool points_cut = false;                  ///< fewer points than configured, because of the time budget
  bool coarse_cut = false;   ///< the coarse stage or further starts skipped or aborted, because of the time budget
  bool over_budget = false;  ///< the sweep took longer than its budget all the same
  StageTimes times;
};

/// Result of one sweep.
struct SweepResult {
  std::int64_t stamp_ns = 0;  ///< time of the pose
  SE3 T_odom_lidar = SE3::Identity();
  Vector6d twist = Vector6d::Zero();         ///< body velocity at the time of the pose [rad/s; m/s]
  Vector6d acceleration = Vector6d::Zero();  ///< its change during the sweep [rad/s²; m/s²]
  Matrix6d covariance = Matrix6d::Zero();    ///< of the pose, right perturbation, [rad; m]
  /// Observability of the three translations from the sweep alone, sensor axes: their block of the information that
  /// wider planes confirm, relative to the largest of the six eigenvalues. Zero for the first sweep and an empty one.
  Eigen::Matrix3d translation_evidence = Eigen::Matrix3d::Zero();
  OdometryStatus status = OdometryStatus::kInitialising;
  SweepStats stats;
};

}  // namespace rilo
