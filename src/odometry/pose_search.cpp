#include "odometry/pose_search.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/optimum.hpp"
#include "registration/closeness.hpp"

namespace rilo {

namespace {
// Where the velocity is not known, the state may be uncertain by metres along a road. A search then stops at this share
// of the usual bound of convergence, or it would stop on the way.
constexpr double kSearchEpsilon = 0.1;
}  // namespace

PoseSearch::PoseSearch(const RegistrationContext& context)
    : context_(context),
      end_(context.tracker.lost() ? context.deadline.after(kTimeShare) : context.deadline),
      icp_(context.config.icp) {
  icp_.epsilon *= kSearchEpsilon;
}

Registration PoseSearch::to_map(const MotionState& start, const MotionPrior& prior, double sigma_th_m,
                                const AdaptiveIcpConfig& icp, const Deadline& deadline) const {
  Registration found;
  found.icp = adaptive_icp(context_.prepared.source, context_.map.map(), start, prior, sigma_th_m, icp, deadline);
  found.T_init = start.T_odom_lidar;
  found.sigma_th_m = sigma_th_m;
  narrow(found, prior, icp, deadline);
  rate(found, context_.map.map());
  return found;
}

// A wide scale leads to where the prediction did not; once there, what moves and what is no plane only draws at the
// pose.
void PoseSearch::narrow(Registration& found, const MotionPrior& prior, AdaptiveIcpConfig icp,
                        const Deadline& deadline) const {
  const AdaptiveThresholdConfig& threshold = context_.config.threshold;
  if (!icp.adaptive || threshold.narrowing <= 1.0) return;
  icp.coarse_stride = 1;
  // Less than half a step is not worth its iterations.
  const double narrow_enough_m = std::sqrt(threshold.narrowing) * threshold.floor_m;
  while (found.sigma_th_m > narrow_enough_m && found.icp.termination == IcpTermination::kConverged) {
    found.sigma_th_m = std::max(found.sigma_th_m / threshold.narrowing, threshold.floor_m);
    const int iterations = found.icp.iterations;
    found.icp = adaptive_icp(context_.prepared.source, context_.map.map(), found.icp.state, prior, found.sigma_th_m,
                             icp, deadline);
    found.icp.iterations += iterations;
  }
}

Registration PoseSearch::from(const MotionState& start, double least_sigma_th_m) const {
  const double sigma_th_m = std::max(context_.sigma_th_m, least_sigma_th_m);
  return to_map(start, context_.tracker.prior(start), sigma_th_m, icp_, end_);
}

void PoseSearch::rate(Registration& found, const LocalMap& map) const {
  found.score = context_.initial_pose.score(context_.prepared.source, found.icp.state, map);
  // The threshold grows tenfold when a vehicle moves off: within it residuals would, too.
  const RegisteredSource sweep{context_.prepared.source, found.icp.state, context_.config.threshold.floor_m,
                               context_.config.icp, kSparseStride};
  found.quality = quality_of(closeness(sweep, map), found.score);
}

LocalMap PoseSearch::map_of(const TimedCloud& cloud, const MotionState& state) const {
  return context_.map.of_sweep(cloud, state, context_.prepared.scene_range_m, context_.pose_by_elevation);
}

}  // namespace rilo
