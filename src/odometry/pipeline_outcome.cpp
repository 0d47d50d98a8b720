// What becomes of a sweep that was judged: it is accepted and learnt from, lost, or the first one of a map.
#include <optional>
#include <utility>

#include "cloud/deskew.hpp"
#include "odometry/health.hpp"
#include "odometry/motion_prior.hpp"
#include "odometry/pipeline.hpp"
#include "registration/plane_residuals.hpp"
#include "registration/uneven_motion.hpp"

namespace rilo {

void Pipeline::accept(const PreparedSweep& prepared, Registration registration, MotionVerdict motion,
                      SweepResult& result) {
  const IcpResult& icp = registration.icp;
  // A map begins with a guess.
  const Vector6d twist_before = registration.first ? registration.first->twist : tracker_.trusted().twist;
  if (registration.first && registration.first->map) {
    map_.replace(std::move(*registration.first->map));
  }
  const bool degenerate = result.status == OdometryStatus::kDegenerate;
  // What this sweep saw, whatever those before did; one that was found again may be degenerate, too.
  const bool sees_too_little = is_degenerate(icp, config_.health);
  result.covariance = covariance_of(prepared, registration, twist_before, degenerate || sees_too_little);
  const Eigen::Vector3d step = tracker_.accept(icp, motion, sees_too_little);

  if (map_.sweeps() >= 2) {
    threshold_.update(registration.T_init, tracker_.state().T_odom_lidar, step - last_step_);
    result.stats.gamma = threshold_.gamma();
    result.stats.deviation_m = threshold_.deviation_m();
  }
  last_step_ = step;

  // In doubt the prediction or a search decides on the pose, and not the angles: its derivative stays what it was.
  if (result.status == OdometryStatus::kOk) {
    calibration_.learn(prepared, icp, registration.sigma_th_m, config_.icp, established(), map_.map());
  }
  calibration_.apply_to(preprocessor_);

  judge_.accept(prepared, registration, degenerate);
  initial_pose_.learn(result.stats.map_score, established() ? std::optional(registration.quality) : std::nullopt);
  initial_pose_.keep_target(prepared.source, tracker_.state().twist);
  const StageTimes& times = result.stats.times;
  budget_.learn(Work::kSettle, 1.0,
                clock_.total_ms() - times.preprocess_ms - times.initial_pose_ms - times.registration_ms);
  insert(prepared.map_cloud, result,
         [&](const TimedCloud& cloud) { map_.insert(cloud, tracker_.state(), calibration_.pose_by_elevation()); });
  calibration_.move(map_.map());
  learn_rest(registration, result);
  contradicted_ = false;
}

/// `twist_before`: the velocity that the sweep was registered after. `vague`: it does not constrain every direction.
Matrix6d Pipeline::covariance_of(const PreparedSweep& prepared, const Registration& registration,
                                 const Vector6d& twist_before, bool vague) {
  const IcpResult& icp = registration.icp;
  const Vector6d uneven = uneven_motion(prepared.source, map_.map(), icp, registration.sigma_th_m, config_.icp,
                                        PoseCovariance::evidence_share(config_.icp), kSampleStride);
  const double since_s = tracker_.since_trusted_s();
  Vector6d acceleration = Vector6d::Zero();
  if (since_s > 0.0) {
    acceleration = (icp.state.twist - twist_before) / since_s;
  }
  const auto sweep_s = static_cast<double>(span_of(prepared.source).length_s());
  return pose_covariance_.of(icp, vague, acceleration, sweep_s, uneven);
}

void Pipeline::lose(const PreparedSweep& prepared, const MotionState& predicted, const std::optional<SE3>& claim,
                    SweepResult& result) {
  result.covariance = guess_covariance();
  if (map_.sweeps() > 1) {
    threshold_.widen();  // the second sweep has no prediction that could be off
  }
  tracker_.lose(predicted, claim);
  if (result.status == OdometryStatus::kEmpty) {
    return;  // nothing contradicts the map
  }
  contradicted_ = true;
  if (judge_.give_up(established(), periods_since_trusted(), result.stats.loss_cause)) {
    begin_map(prepared, claim ? MotionState{*claim, predicted.twist} : predicted, result);
  }
}

void Pipeline::begin_map(const PreparedSweep& prepared, const MotionState& guess, SweepResult& result) {
  result.status = OdometryStatus::kInitialising;
  const MotionState state = tracker_.begin(guess);
  judge_.begin(prepared, result.stats.loss_cause == LossCause::kCovered);
  insert(prepared.map_cloud, result, [&](const TimedCloud& cloud) {
    map_.begin(cloud, state, prepared.scene_range_m, calibration_.pose_by_elevation());
  });
  threshold_.reset();
  initial_pose_.begin(prepared.source, state, map_.map());
}

}  // namespace rilo
