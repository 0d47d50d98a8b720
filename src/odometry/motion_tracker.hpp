// The motion so far, from trusted sweeps, and the motion to expect.
#pragma once

#include <cstdint>
#include <optional>

#include "odometry/motion_prior.hpp"
#include "odometry/pose_noise.hpp"
#include "odometry/reach.hpp"
#include "odometry/stamp_trust.hpp"
#include "odometry/sweep_clock.hpp"
#include "odometry/turn_noise.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/known_velocity.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Verdict on the motion to a pose.
enum class MotionVerdict : std::uint8_t {
  kPossible,    ///< from the last trusted pose
  kJump,        ///< not in that time, but the pose is right: two sweeps agree on it, or the sweep fits as usual
  kImpossible,  ///< nor is there more that speaks for it
};

/// Follows the sensor on a time of its own. Only poses that were accepted enter; a velocity is never taken from a
/// motion whose time is in doubt: after a loss or a jump the velocity from before is kept.
class MotionTracker {
 public:
  MotionTracker(const MotionPredictionConfig& prediction, const MotionPriorConfig& prior,
                const MotionBoundsConfig& bounds)
      : prediction_config_(prediction), prior_config_(prior), turn_noise_(prior), bounds_(bounds) {}

  /// The next sweep came so much later than the one before; its deviation from an even clock counts as far as motion
  /// confirmed those before.
  void advance(const SweepTime& time);

  /// State of the last sweep: registered, or guessed when that failed.
  const MotionState& state() const { return state_; }
  /// State of the last sweep that was accepted, and the time since (s).
  const MotionState& trusted() const { return trusted_state_; }
  double since_trusted_s() const { return seconds_since(past_.empty() ? 0 : past_.back().stamp_ns); }
  /// Whether the sweep before could not be registered.
  bool lost() const { return lost_; }
  /// The last sweep that was accepted said too little in one direction.
  bool degenerate() const { return degenerate_; }

  /// T_pred (III-B) from the trusted poses, and the velocity.
  MotionState predicted(double sigma_th_m) const;
  /// The same from the pose that the sweep before had when it was rejected, if it was.
  std::optional<MotionState> predicted_from_claim() const;
  /// Velocity of a sweep at `T_odom_lidar`: what the motion there implies, where a sensor can move so.
  Vector6d implied_twist(const SE3& T_odom_lidar) const;
  /// Prior of the registration; `refuted`: start there, the motion so far does not count.
  MotionPrior prior(const std::optional<MotionState>& refuted) const;
  /// Prior of the last accepted sweep, from the present one as registered.
  MotionPrior prior_before(const IcpResult& present) const;

  /// Where the sensor may be now, from the motion up to the last trusted pose.
  Reach reach() const;

  /// Of a registered sweep: its pose, and the velocity during it, where the one before is more than a guess.
  MotionVerdict weigh(const MotionState& registered) const;
  /// Whether that is the last trusted pose again.
  bool stayed(const SE3& T_odom_lidar) const {
    return within_pose_noise(se3_log(trusted_state_.T_odom_lidar.inverse() * T_odom_lidar));
  }

  /// A map begins at `guess`, with the velocity there unless that is known better. Returns the state of its first
  /// sweep.
  MotionState begin(const MotionState& guess);
  /// Whether the map began with a known velocity, and no sweep came since.
  bool begun_moving() const { return begun_moving_; }
  /// Takes the registered state of a sweep. Returns the displacement since the last trusted pose (sensor frame, m).
  Eigen::Vector3d accept(const IcpResult& icp, MotionVerdict verdict, bool degenerate);
  /// Continues at the prediction; `claim`: pose at which the sweep fitted the map, had the motion been possible.
  void lose(const MotionState& predicted, const std::optional<SE3>& claim);

  /// `known`: for maps that begin before the time of that velocity.
  void reset(const std::optional<KnownVelocity>& known = std::nullopt);

 private:
  struct Claim {
    SE3 T_odom_lidar;
    std::int64_t at_ns = 0;
    std::optional<SE3> step;  // from the claim of the sweep before, ...
    double step_s = 0;        // ... which was so long ago
  };
  double seconds_since(std::int64_t at_ns) const { return static_cast<double>(now_ns_ - at_ns) * 1e-9; }
  /// Of the next sweep and the last trusted pose.
  TimeStep since_trusted() const { return {since_trusted_s(), stamp_trust_.error_s(deviation_s())}; }
  /// Of the time since the trusted pose by the stamps from that of an even clock.
  double deviation_s() const { return static_cast<double>(deviation_ns_) * 1e-9; }
  /// Accelerations to expect now.
  MotionPriorConfig expected_prior() const;
  void remember(bool timed);
  bool agrees_with_claim(const SE3& T_odom_lidar) const;

  MotionPredictionConfig prediction_config_;
  MotionPriorConfig prior_config_;
  TurnNoise turn_noise_;
  MotionBoundsConfig bounds_;
  StampTrust stamp_trust_;
  std::int64_t now_ns_ = 0;        // sum of the steps, as far as their stamps are believed
  std::int64_t deviation_ns_ = 0;  // of the stamps since the last trusted pose
  Trajectory past_;                // the last trusted poses, at most three, stamped with now_ns_
  MotionState state_;
  MotionState trusted_state_;
  Matrix6d velocity_covariance_ = Matrix6d::Identity();  // set where a map begins
  std::optional<SE3> step_;                              // the last motion whose time is not in doubt, ...
  double step_s_ = 0;                                    // ... and how long it took
  std::optional<Claim> claim_;
  std::optional<KnownVelocity> known_;
  bool begun_moving_ = false;
  bool lost_ = false;
  bool degenerate_ = false;
};

}  // namespace rilo
