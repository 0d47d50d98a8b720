// Reliable initial pose: coarse registration when it is worth it (III-A), and the choice against the prediction
// (III-B).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cloud/timed_cloud.hpp"
#include "cloud/voxel_sampler.hpp"
#include "map/local_map.hpp"
#include "odometry/reach.hpp"
#include "registration/adaptive_icp.hpp"
#include "registration/coarse_registration.hpp"
#include "rilo/odometry/odometry_config.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// T_init and why.
struct InitialPose {
  SE3 T_odom_lidar = SE3::Identity();
  InitialPoseSource source = InitialPoseSource::kPrediction;
  InitialPoseReason reason = InitialPoseReason::kCoarseNotNeeded;
  int coarse_starts = 0;             ///< of the coarse stage; 0: it did not run
  int coarse_iterations = 0;         ///< over all starts
  bool coarse_cut = false;           ///< not run, or not from all starts, because of the time budget
  double prediction_score = 0;       ///< map score of T_pred, 0 … 1
  double pred_align_distance_m = 0;  ///< Δt_i
};

/// Candidate poses with their map scores.
struct ScoredPose {
  SE3 T_odom_lidar = SE3::Identity();
  double score = 0;
};

/// The rule of III-B: chooses between prediction and coarse result, both in the odometry frame.
InitialPose select_initial_pose(const ScoredPose& prediction, const ScoredPose& coarse,
                                const InitialPoseConfig& config);

/// The stage: knows the usual score and the last sweep's cloud.
class InitialPoseStage {
 public:
  InitialPoseStage(const InitialPoseConfig& config, const CoarseRegistrationConfig& coarse)
      : config_(config), coarse_(coarse) {}

  /// What the choice is made from.
  struct Situation {
    const TimedCloud& source;                             ///< the sweep: points (m, sensor frame) with their times
    const MotionState& predicted;                         ///< T_pred and the velocity during the sweep
    const SE3& previous;                                  ///< T_{i−1}, the pose of the last sweep that was accepted
    const std::function<Vector6d(const SE3&)>& twist_at;  ///< velocity of the sweep, were its pose the one given
    const LocalMap& map;                                  ///< judges the candidates
    /// The map holds one sweep, compensated for predicted.twist: only a sweep compensated for the same looks like it,
    /// whatever motion its candidate implies.
    bool single = false;
    bool in_doubt = false;            ///< the prediction must not be trusted whatever its score (start, after a loss)
    std::optional<Reach> reach = {};  ///< after a gap: where the sensor may be, from the motion before
    Deadline deadline = {};           ///< of the coarse stage
    double coarse_share = 1.0;        ///< of the points of the coarse stage
  };

  /// Chooses the initial pose of a sweep.
  InitialPose choose(const Situation& situation);

  /// Map score of a registered sweep.
  double score(const TimedCloud& source, const MotionState& state, const LocalMap& map) const;

  /// Whether a registered sweep fits the map rather than its surroundings; see rilo::stands_out().
  bool stands_out(const TimedCloud& source, const MotionState& state, const LocalMap& map) const;

  /// Whether a registered sweep fits so much worse than usual that it may have been taken at another time than its
  /// stamp; see quality_of().
  bool suspicious(double quality) const;

  /// Updates the usual score: slowly with a score that raises the alarm. A pose that slides away slowly
  /// must not take the reference along, and a place with less structure must become usual in time. The
  /// quality_of() on a map of few sweeps is not comparable with later ones: none.
  void learn(double score, std::optional<double> quality);

  /// A map begins with a sweep: its cloud becomes the target, its score the least that is expected.
  void begin(const TimedCloud& source, const MotionState& state, const LocalMap& map);

  /// Usual quality_of() of accepted sweeps; 0: unknown.
  double usual_quality() const { return usual_quality_; }

  /// The usual score, or, while it is not known, what the first sweep of the map scores on itself.
  double expected_score() const { return usual_score_ > 0.0 ? usual_score_ : own_score_; }

  /// Keeps the source of a sweep as target of the next coarse registration, to be compensated for `twist`. What
  /// search() made of it serves as it is where the velocity there was about the same.
  void keep_target(const TimedCloud& source, const Vector6d& twist);
  /// That source.
  const TimedCloud& last_source() const { return target_source_; }

  void reset();

 private:
  /// What the coarse stage found.
  struct Search {
    ScoredPose best;
    int iterations = 0;
    int starts = 0;
    bool cut = false;  // no time for further starts
  };
  /// Coarse registrations from the prediction and, in doubt, from further starts, until one is consistent.
  Search search(const Situation& situation, bool doubt);
  void consider(const Situation& situation, const SE3& T, ScoredPose& best);
  void try_from(const Situation& situation, const SE3& start, Search& search);
  /// Score of a candidate: on the sweep compensated for `twist`; with more points in the single case, where the
  /// candidates differ by few of them.
  double candidate_score(const Situation& situation, const SE3& T, const Vector6d& twist) const;
  DistributionCloud distribution(const std::vector<Eigen::Vector3f>& points, double share);
  /// Whether a score is not far below the usual one.
  bool is_consistent(double score) const;
  /// Further starts for the coarse stage: the best poses of a search, on the sweep as compensated last.
  std::vector<SE3> restarts(const Situation& situation) const;

  InitialPoseConfig config_;
  CoarseRegistrationConfig coarse_;
  VoxelSampler sampler_;
  std::vector<Eigen::Vector3f> compensated_;
  TimedCloud target_source_;
  Vector6d target_twist_ = Vector6d::Zero();
  // Of the last sweep, once it is needed; of this one, compensated for moving_twist_, when it was needed.
  std::optional<DistributionCloud> target_;
  std::optional<DistributionCloud> moving_;
  bool restarts_due_ = false;  // the search of the last sweep found nothing and had no time for them
  Vector6d moving_twist_ = Vector6d::Zero();
  double usual_score_ = 0;
  double usual_quality_ = 0;
  double own_score_ = 0;  // of the first sweep on the map of itself: what a sweep at the right place can reach
};

}  // namespace rilo
