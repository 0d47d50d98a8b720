#include "odometry/motion_tracker.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "odometry/motion_bounds.hpp"
#include "odometry/motion_prediction.hpp"

namespace rilo {

namespace {
constexpr std::size_t kRememberedPoses = 3;  // (III-B)
// Of the parabola through the last three velocities, whose whole would take their noise for motion (experiment: change
// of the acceleration).
constexpr double kCurvature = 0.5;
constexpr double kStepBeforeS = 0.1;  // with a known velocity a map begins as if the sensor had come that long
constexpr double kStaleSteps = 3.0;   // after a loss this long the motion before is no evidence

Matrix6d velocity_covariance_of(const IcpResult& icp) {
  const Matrix12d covariance = icp.posterior_information.ldlt().solve(Matrix12d::Identity());
  return covariance.bottomRightCorner<6, 6>();
}

/// Accelerations of a sensor of which little is seen.
MotionPriorConfig steady(MotionPriorConfig config) {
  config.acceleration_m_s2 *= config.unseen_share;
  config.angular_acceleration_rad_s2 *= config.unseen_share;
  return config;
}
}  // namespace

void MotionTracker::advance(const SweepTime& time) {
  const std::int64_t deviation_ns = time.step_ns - time.even_ns;
  deviation_ns_ += deviation_ns;
  now_ns_ += time.even_ns + std::llround(stamp_trust_.share() * static_cast<double>(deviation_ns));
}

MotionState MotionTracker::predicted(double sigma_th_m) const {
  MotionState state{predict_pose(past_, now_ns_, sigma_th_m, prediction_config_), trusted_state_.twist};
  if (past_.size() > 1 && !lost_) {
    const double lag_s = since_trusted_s();
    state.earlier = {trusted_state_.twist, lag_s};
    const double lag_before_s = trusted_state_.earlier.lag_s;
    // Along a direction that is not observed the velocity says nothing of its changes.
    if (lag_before_s > 0.0 && !degenerate_) {
      state.earlier.acceleration = trusted_state_.mean_acceleration();
      state.earlier.share = kCurvature * lag_s / (lag_s + lag_before_s);
    }
  }
  return state;
}

std::optional<MotionState> MotionTracker::predicted_from_claim() const {
  if (!claim_) {
    return std::nullopt;
  }
  const double dt_s = seconds_since(claim_->at_ns);
  return MotionState{claim_->T_odom_lidar * se3_exp(dt_s * trusted_state_.twist), trusted_state_.twist};
}

Vector6d MotionTracker::implied_twist(const SE3& T_odom_lidar) const {
  const SE3 motion = trusted_state_.T_odom_lidar.inverse() * T_odom_lidar;
  const double dt_s = since_trusted_s();
  if (!possible_motion(motion, dt_s, step_, step_s_, bounds_)) {
    return trusted_state_.twist;
  }
  return se3_log(motion) / dt_s;
}

MotionPriorConfig MotionTracker::expected_prior() const {
  // Where nothing is seen, each sweep makes the prior weaker, and at last the least noise or bias outweighs it.
  return degenerate_ ? steady(turn_noise_.expected()) : turn_noise_.expected();
}

MotionPrior MotionTracker::prior(const std::optional<MotionState>& refuted) const {
  const TimeStep step = since_trusted();
  if (refuted) {
    return motion_prior(*refuted, unknown_velocity_covariance(), step, expected_prior());
  }
  return motion_prior(expected_motion(trusted_state_, step.s), velocity_covariance_, step, expected_prior());
}

MotionPrior MotionTracker::prior_before(const IcpResult& present) const {
  TimeStep step = since_trusted();
  step.s = -step.s;
  const SE3 T_before = present.state.T_odom_lidar * se3_exp(step.s * present.state.twist);
  return motion_prior({T_before, present.state.twist}, velocity_covariance_of(present), step, turn_noise_.expected());
}

Reach MotionTracker::reach() const {
  const double dt_s = since_trusted_s();
  const Vector6d variance = pose_covariance_after(velocity_covariance_, dt_s, turn_noise_.expected()).diagonal();
  return {expected_motion(trusted_state_, dt_s).T_odom_lidar, std::sqrt(variance.tail<3>().maxCoeff()),
          std::sqrt(variance.head<3>().maxCoeff())};
}

MotionVerdict MotionTracker::weigh(const MotionState& registered) const {
  const SE3 motion = trusted_state_.T_odom_lidar.inverse() * registered.T_odom_lidar;
  const TimeStep step = since_trusted();
  const double most_s = step.s + step.error_s;  // a stamp that may be late refutes nothing
  const Vector6d change = registered.twist_in_odom() - trusted_state_.twist_in_odom();
  if (possible_motion(motion, most_s, step_, step_s_, bounds_) &&
      (!step_ || possible_change(change, most_s, bounds_))) {
    return MotionVerdict::kPossible;
  }
  return agrees_with_claim(registered.T_odom_lidar) ? MotionVerdict::kJump : MotionVerdict::kImpossible;
}

bool MotionTracker::agrees_with_claim(const SE3& T_odom_lidar) const {
  if (!claim_) {
    return false;
  }
  const SE3 motion = claim_->T_odom_lidar.inverse() * T_odom_lidar;
  const double dt_s = seconds_since(claim_->at_ns);
  return (step_ && possible_motion(motion, dt_s, step_, step_s_, bounds_)) ||
         (claim_->step && possible_motion(motion, dt_s, claim_->step, claim_->step_s, bounds_));
}

MotionState MotionTracker::begin(const MotionState& guess) {
  state_ = guess;
  velocity_covariance_ = unknown_velocity_covariance();
  past_.clear();
  step_.reset();
  const double until_known_s = known_ ? known_->at_s - static_cast<double>(now_ns_) * 1e-9 : 0.0;
  begun_moving_ = until_known_s > 0.0;
  if (begun_moving_) {
    state_.twist = known_->twist;
    velocity_covariance_ = until_known_s * acceleration_density(steady(prior_config_));
    step_ = se3_exp(kStepBeforeS * known_->twist);
    step_s_ = kStepBeforeS;
    past_.push_back({now_ns_ - std::llround(kStepBeforeS * 1e9), state_.T_odom_lidar * step_->inverse()});
  }
  past_.push_back({now_ns_, state_.T_odom_lidar});
  trusted_state_ = state_;
  deviation_ns_ = 0;
  claim_.reset();
  lost_ = false;
  degenerate_ = false;
  return state_;
}

Eigen::Vector3d MotionTracker::accept(const IcpResult& icp, MotionVerdict verdict, bool degenerate) {
  const double dt_s = since_trusted_s();
  const Vector6d velocity_before = trusted_state_.twist;
  const SE3 motion = trusted_state_.T_odom_lidar.inverse() * icp.state.T_odom_lidar;
  if (step_ && !lost_ && verdict == MotionVerdict::kPossible) {
    const MotionState expected = expected_motion(trusted_state_, dt_s);
    const MotionPrior prior = motion_prior(expected, velocity_covariance_, {dt_s}, expected_prior());
    turn_noise_.learn(expected, velocity_covariance_, since_trusted(), icp);
    stamp_trust_.learn(deviation_s(), prior, icp);
  }
  const bool jump = verdict == MotionVerdict::kJump;
  state_ = icp.state;
  state_.T_odom_lidar = renormalised(state_.T_odom_lidar);
  trusted_state_ = state_;
  if (jump) {
    trusted_state_.twist = velocity_before;
  }
  remember(!lost_ && !jump);
  deviation_ns_ = 0;
  if (lost_) {  // the velocity stays unknown, see lose()
    if (jump && agrees_with_claim(state_.T_odom_lidar)) {
      step_ = claim_->T_odom_lidar.inverse() * state_.T_odom_lidar;
      step_s_ = seconds_since(claim_->at_ns);
    } else if (dt_s > kStaleSteps * step_s_) {
      step_.reset();
    }
  } else if (!jump) {
    step_ = motion;
    step_s_ = dt_s;
    velocity_covariance_ = velocity_covariance_of(icp);
  }
  claim_.reset();
  known_.reset();
  begun_moving_ = false;
  lost_ = false;
  degenerate_ = degenerate;
  return motion.translation();
}

/// The pose of the accepted sweep; `timed`: the sensor came there from the pose before in the time since.
void MotionTracker::remember(bool timed) {
  if (!timed && past_.size() >= 2) {
    // As if it had come here at the velocity from before.
    const double step_s = static_cast<double>(past_.back().stamp_ns - past_[past_.size() - 2].stamp_ns) * 1e-9;
    const SE3 step = past_[past_.size() - 2].T_odom_lidar.inverse() * past_.back().T_odom_lidar;
    past_ = {{now_ns_ - std::int64_t(step_s * 1e9), state_.T_odom_lidar * step.inverse()}};
  }
  past_.push_back({now_ns_, state_.T_odom_lidar});
  if (past_.size() > kRememberedPoses) {
    past_.erase(past_.begin());
  }
}

void MotionTracker::lose(const MotionState& predicted, const std::optional<SE3>& claim) {
  state_ = predicted;
  velocity_covariance_ = unknown_velocity_covariance();
  begun_moving_ = false;
  lost_ = true;
  if (!claim) {
    claim_.reset();
    return;
  }
  Claim next{*claim, now_ns_, std::nullopt, 0.0};
  if (claim_) {
    next.step = claim_->T_odom_lidar.inverse() * *claim;
    next.step_s = seconds_since(claim_->at_ns);
  }
  claim_ = next;
}

void MotionTracker::reset(const std::optional<KnownVelocity>& known) {
  *this = MotionTracker(prediction_config_, prior_config_, bounds_);
  known_ = known;
}

}  // namespace rilo
