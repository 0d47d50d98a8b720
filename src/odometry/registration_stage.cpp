#include "odometry/registration_stage.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "odometry/health.hpp"
#include "odometry/optimum.hpp"
#include "odometry/path_search.hpp"
#include "odometry/pose_search.hpp"
#include "odometry/second_sweep.hpp"

namespace rilo {

namespace {
/// A direction that was seen is no longer: where a sweep does not belong, what shows that direction finds no match.
bool newly_degenerate(const RegistrationParts& parts, const Registration& found) {
  return is_degenerate(found.icp, parts.config.health) && !parts.tracker.degenerate();
}

/// What was found within a wide gate has to hold within the usual one.
Registration held(const RegistrationParts& parts, const PoseSearch& search, const Registration& found) {
  Registration again = search.to_map(found.icp.state, parts.tracker.prior(found.icp.state), parts.usual_sigma_th_m,
                                     search.icp(), parts.deadline);
  again.T_init = found.T_init;
  again.starts = found.starts;
  again.cut = found.cut;
  again.ambiguous = found.ambiguous;
  return again;
}

/// Where the coarse result leads elsewhere, and the sweep fits there worse than usual, the prediction may have been
/// right: of both the better counts, and none where they fit about as well.
void compare_with_prediction(const RegistrationParts& parts, const PoseSearch& search, const MotionState& predicted,
                             Registration& found) {
  constexpr double kAboutAsWell = 0.8;  // of the better quality (experiment: the prediction beside the coarse result)
  Registration other =
      search.to_map(predicted, parts.tracker.prior(std::nullopt), parts.sigma_th_m, parts.config.icp, search.end());
  found.starts = other.starts = found.starts + 1;
  if (!elsewhere(other.icp.state.T_odom_lidar, found.icp.state.T_odom_lidar)) {
    return;
  }
  const auto [less, more] = std::minmax(found.quality, other.quality);
  const bool ambiguous = less > kAboutAsWell * more;
  if (settled(other.icp) && (!settled(found.icp) || other.quality > found.quality)) {
    found = std::move(other);
  }
  found.ambiguous = found.ambiguous || ambiguous;
}

/// A sweep of another time lies where no velocity of the sensor led to, and what its pose implies bends it: once more
/// from there with the velocity before, kept where the sweep then fits as usual.
void retry_as_before(const RegistrationParts& parts, const PoseSearch& search, Registration& found) {
  Registration other = search.from({found.T_init, parts.tracker.trusted().twist});
  found.starts = other.starts = found.starts + 1;
  if (settled(other.icp) && !parts.initial_pose.suspicious(other.quality)) {
    found = std::move(other);
  }
}
}  // namespace

Registration fine_registration(const RegistrationParts& parts, const MotionState& predicted, const InitialPose& init) {
  const PoseSearch search(parts);
  if (parts.tracker.begun_moving()) {
    // The motion is known better than two sweeps alone show it.
    return search.to_map(predicted, parts.tracker.prior(std::nullopt), parts.sigma_th_m, parts.config.icp,
                         search.end());
  }
  MotionState initial = predicted;
  std::optional<MotionState> refuted;
  if (init.source == InitialPoseSource::kCoarse || parts.tracker.lost()) {
    // The sweep has just refuted the prediction: start where it fits, with the velocity that this implies.
    initial = {init.T_odom_lidar, parts.tracker.implied_twist(init.T_odom_lidar)};
    refuted = initial;
  }
  if (parts.map.sweeps() == 1) {
    return SecondSweep(parts, search).registered(initial, parts.tracker.prior(refuted));
  }
  Registration found = refuted ? search.from(initial)
                               : search.to_map(initial, parts.tracker.prior(std::nullopt), parts.sigma_th_m,
                                               parts.config.icp, search.end());
  if (parts.tracker.lost() && !parts.contradicted) {
    // Within the wide gate the pose is a coarse one, and nothing speaks for another place.
    Registration usual = held(parts, search, found);
    if (!parts.initial_pose.suspicious(usual.quality) && !newly_degenerate(parts, usual)) {
      return usual;
    }
  }
  // Where the sensor cannot have moved so, the velocity before is what it started with. After a gap to try it takes
  // time for nothing (experiment: search from coarse to fine).
  const bool implied = refuted && !parts.after_gap && initial.twist != parts.tracker.trusted().twist;
  if (implied && parts.initial_pose.suspicious(found.quality) && !search.end().passed()) {
    retry_as_before(parts, search, found);
  }
  if (refuted && !parts.tracker.lost() && parts.initial_pose.suspicious(found.quality) && !search.end().passed()) {
    compare_with_prediction(parts, search, predicted, found);
  }
  if (parts.initial_pose.suspicious(found.quality) || newly_degenerate(parts, found)) {
    found.cut = search.end().passed();
    if (!found.cut) {
      PathSearch(parts, search).improve(predicted, found);
    }
  }
  return parts.tracker.lost() ? held(parts, search, found) : std::move(found);
}

}  // namespace rilo
