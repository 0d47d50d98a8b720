// Fine registration of a sweep from its initial pose (III-D), the second sweep of a map and doubtful fits included.
#pragma once

#include <optional>
#include <vector>

#include "cloud/preprocess.hpp"
#include "geometry/pose_derivative.hpp"
#include "odometry/initial_pose.hpp"
#include "odometry/motion_tracker.hpp"
#include "odometry/sweep_map.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// The first sweep of a map, as the second one shows it.
struct FirstSweep {
  std::optional<LocalMap> map;        ///< of it alone, compensated with `twist`, if timed
  Vector6d twist = Vector6d::Zero();  ///< body velocity [rad/s; m/s]
};

/// A sweep as registered, before it is judged.
struct Registration {
  IcpResult icp;
  SE3 T_init = SE3::Identity();     ///< initial pose of the registration that was kept
  std::optional<FirstSweep> first;  ///< second sweep of a map
  double score = 0;                 ///< map score at the registered pose
  double quality = 0;               ///< see quality_of()
  double rival_quality = 0;         ///< second sweep: the best that settled elsewhere
  bool ambiguous = false;           ///< it may as well lie elsewhere
  int starts = 1;                   ///< how many it was chosen from
  bool cut = false;                 ///< no time for further ones
};

/// Registers one sweep; refers to the state of the odometry, which outlives it.
class RegistrationStage {
 public:
  /// Parts of the odometry that the registration reads.
  struct Parts {
    const OdometryConfig& config;
    const PreparedSweep& prepared;
    const MotionTracker& tracker;
    const SweepMap& map;
    InitialPoseStage& initial_pose;
    const PoseDerivative& pose_by_elevation;
    double sigma_th_m = 0;
    double usual_sigma_th_m = 0;  ///< the same without the growth after failures
    double period_s = 0;          ///< usual time between sweeps
    Deadline deadline = {};       ///< of the registration
    double first_map_ms = 0;      ///< how long it takes to put the first sweep into a map, and this one
  };
  explicit RegistrationStage(const Parts& parts);

  Registration run(const MotionState& predicted, const InitialPose& init) const;

 private:
  Registration from(const MotionState& start, const MotionPrior& prior, int rounds, const AdaptiveIcpConfig& icp) const;
  Registration to_map(const MotionState& start, const MotionPrior& prior, double sigma_th_m,
                      const AdaptiveIcpConfig& icp, const Deadline& deadline) const;
  Registration second_sweep(const MotionState& start, const MotionPrior& first_prior, int rounds) const;
  std::optional<LocalMap> of_first_sweep(const TimedCloud& first, const Vector6d& twist) const;
  Vector6d twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const;
  const LocalMap& or_present(const std::optional<LocalMap>& compensated) const;
  void try_from(const MotionState& start, int rounds, Registration& found) const;
  void try_all(const std::vector<MotionState>& starts, int rounds, Registration& found) const;
  void rate(Registration& found, const LocalMap& map) const;
  /// Where a sample of the sweep comes to rest from a start, and how well it fits there.
  struct SampleFit {
    MotionState state;
    double quality = 0;  ///< 0: not tried
  };
  bool newly_degenerate(const Registration& found) const;
  /// Quality of fits over that of the fits beside them.
  struct PathProfile {
    std::size_t best = 0;
    double outstanding = 0;  ///< of the best
    double found = 0;        ///< where the sweep was found; 0: no fit ends there
    double noise = 0;        ///< median distance from 1
  };
  static PathProfile profile_of(const std::vector<SampleFit>& fits, const Registration& found);
  void try_on_path(const MotionState& predicted, Registration& found) const;
  std::vector<SampleFit> fits_on_path(const MotionState& predicted, const Deadline& end) const;
  SampleFit fit_of(const TimedCloud& sample, const MotionState& start, const LocalMap& map,
                   const Deadline& deadline) const;
  std::vector<MotionState> other_second_starts(const Registration& found) const;

  static constexpr int kFirstSweepRounds = 3;  // each compensates the first sweep with the velocity of the one before
  static constexpr int kNearbyRounds = 2;  // the last ones: the wide gate of the first may leave the basin of the start
  /// Of the time left; after a loss, what was found has to hold in the rest of it.
  static constexpr double kSearchShare = 0.7;

  Parts parts_;
  Deadline search_end_;
  AdaptiveIcpConfig searching_;  // where no velocity is known
  /// A share of the points of both sweeps, while the second one of a map is sought.
  struct Draft {
    TimedCloud source;
    TimedCloud map_cloud;
    TimedCloud first;  ///< of the map cloud of the first sweep
  };
  static constexpr double kDraftShare = 1.0 / 3.0;  // with a quarter fewer second sweeps are certain
  std::optional<Draft> draft_;
};

}  // namespace rilo
