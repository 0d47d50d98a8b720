#include "odometry/registration_stage.hpp"

#include <algorithm>
#include <utility>

namespace rilo {

namespace {
constexpr int kFirstSweepRounds = 3;  // each compensates the first sweep with the velocity of the round before
}  // namespace

Registration RegistrationStage::run(const MotionState& predicted, const InitialPose& init) const {
  MotionState initial = predicted;
  std::optional<MotionState> refuted;
  if (init.source == InitialPoseSource::kCoarse || parts_.tracker.lost()) {
    // The sweep has just refuted the prediction: start where it fits, with the velocity that this implies.
    initial = {init.T_odom_lidar, parts_.tracker.implied_twist(init.T_odom_lidar)};
    refuted = initial;
  }
  const MotionPrior prior = parts_.tracker.prior(refuted);
  if (parts_.map.first_can_be_compensated()) {
    return second_sweep(initial, prior);
  }
  Registration found = from(initial, prior);
  if (parts_.initial_pose.suspicious(found.score, found.icp.residual_rms_m)) {
    try_places_on_path(predicted, found);
  }
  return found;
}

Registration RegistrationStage::from(const MotionState& start, const MotionPrior& prior) const {
  Registration found;
  found.icp =
      adaptive_icp(parts_.prepared.source, parts_.map.map(), start, prior, parts_.sigma_th_m, parts_.config.icp);
  found.T_init = start.T_odom_lidar;
  found.score = parts_.initial_pose.score(parts_.prepared.source, found.icp.state, parts_.map.map());
  return found;
}

/// Missing or reordered sweeps lie elsewhere on the path.
void RegistrationStage::try_places_on_path(const MotionState& predicted, Registration& found) const {
  for (const SE3& place :
       parts_.initial_pose.places_on_path(parts_.prepared.source, predicted, parts_.period_s, parts_.map.map())) {
    if (!parts_.time_left()) {
      return;
    }
    const MotionState start{place, parts_.tracker.implied_twist(place)};
    Registration other = from(start, parts_.tracker.prior(start));
    if (other.score * found.icp.residual_rms_m >
        (1.0 + parts_.config.initial_pose.margin) * found.score * other.icp.residual_rms_m) {
      found = std::move(other);
    }
  }
}

/// The first sweep went into the map as if the sensor had stood still. It is compensated with the velocity that the
/// second one implies, which the registration refines.
Registration RegistrationStage::second_sweep(const MotionState& initial, const MotionPrior& first_prior) const {
  Registration found;
  found.icp.state = initial;
  found.T_init = initial.T_odom_lidar;
  int iterations = 0;
  double sigma_m = parts_.sigma_th_m;
  for (int round = 0; round < kFirstSweepRounds; ++round) {
    found.map =
        parts_.map.first_compensated(found.icp.state.twist, parts_.prepared.scene_range_m, parts_.pose_by_elevation);
    const MotionPrior prior = round == 0 ? first_prior : parts_.tracker.prior(found.icp.state);
    found.icp = adaptive_icp(parts_.prepared.source, *found.map, found.icp.state, prior, sigma_m, parts_.config.icp);
    iterations += found.icp.iterations;
    sigma_m = std::max(0.5 * sigma_m, parts_.config.threshold.floor_m);  // each round starts nearer
  }
  found.icp.iterations = iterations;
  found.score = parts_.initial_pose.score(parts_.prepared.source, found.icp.state, *found.map);
  return found;
}

}  // namespace rilo
