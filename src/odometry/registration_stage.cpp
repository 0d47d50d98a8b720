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
bool newly_degenerate(const RegistrationContext& context, const Registration& found) {
  return is_degenerate(found.icp, context.config.health) && !context.tracker.degenerate();
}

/// What was found within a wide gate has to hold within the usual one.
Registration held(const RegistrationContext& context, const PoseSearch& search, const Registration& found) {
  Registration again = search.to_map(found.icp.state, context.tracker.prior(found.icp.state), context.usual_sigma_th_m,
                                     search.icp(), context.deadline);
  again.T_init = found.T_init;
  again.starts = found.starts;
  again.cut = found.cut;
  again.ambiguous = found.ambiguous;
  return again;
}

/// Where the coarse result leads elsewhere, and the sweep fits there worse than usual, the prediction may have been
/// right: of both the better counts, and none where they fit about as well.
void compare_with_prediction(const RegistrationContext& context, const PoseSearch& search, const MotionState& predicted,
                             Registration& found) {
  constexpr double kAboutAsWell = 0.8;  // of the better quality (experiment: the prediction beside the coarse result)
  Registration other = search.to_map(predicted, context.tracker.prior(std::nullopt), context.sigma_th_m,
                                     context.config.icp, search.end());
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

/// A sensor that stops or turns round leaves the basin of the usual gate, and the sweep creeps within it. Once more as
/// if nothing were known of the motion: from no motion, with the threshold of the beginning. Kept where it fits clearly
/// better.
void retry_from_rest(const RegistrationContext& context, const PoseSearch& search, Registration& found) {
  const MotionState at_rest{context.tracker.trusted().T_odom_lidar, Vector6d::Zero()};
  Registration other = search.from(at_rest, context.config.threshold.initial_m);
  found.starts = other.starts = found.starts + 1;
  if (settled(other.icp) && suspicious(found.quality, other.quality)) {
    found = std::move(other);
  }
}

/// A sweep of another time lies where no velocity of the sensor led to, and what its pose implies bends it: once more
/// from there with the velocity before, kept where the sweep then fits as usual.
void retry_as_before(const RegistrationContext& context, const PoseSearch& search, Registration& found) {
  Registration other = search.from({found.T_init, context.tracker.trusted().twist});
  found.starts = other.starts = found.starts + 1;
  if (settled(other.icp) && !context.initial_pose.suspicious(other.quality)) {
    found = std::move(other);
  }
}

/// What fits worse than usual, from other starts than its own. `refuted`: that start, where the prediction was none.
void try_other_starts(const RegistrationContext& context, const PoseSearch& search, const MotionState& predicted,
                      const std::optional<MotionState>& refuted, Registration& found) {
  constexpr double kMuchWorse = 0.85;  // of what is suspicious (experiment: registered from rest)
  const auto due = [&](double share = 1.0) {
    return context.initial_pose.suspicious(found.quality / share) && !search.end().passed();
  };
  if (!refuted) {
    if (due(kMuchWorse)) {
      retry_from_rest(context, search, found);
    }
    return;
  }
  // Where the sensor cannot have moved so, the velocity before is what it started with. After a gap to try it takes
  // time for nothing (experiment: search from coarse to fine).
  const bool implied = !context.after_gap && refuted->twist != context.tracker.trusted().twist;
  if (implied && due()) {
    retry_as_before(context, search, found);
  }
  if (!context.tracker.lost() && due()) {
    compare_with_prediction(context, search, predicted, found);
  }
}
}  // namespace

Registration fine_registration(const RegistrationContext& context, const MotionState& predicted,
                               const InitialPose& init) {
  const PoseSearch search(context);
  if (context.tracker.begun_moving()) {
    // The motion is known better than two sweeps alone show it.
    return search.to_map(predicted, context.tracker.prior(std::nullopt), context.sigma_th_m, context.config.icp,
                         search.end());
  }
  MotionState initial = predicted;
  std::optional<MotionState> refuted;
  if (init.source == InitialPoseSource::kCoarse || context.tracker.lost()) {
    // The sweep has just refuted the prediction: start where it fits, with the velocity that this implies.
    initial = {init.T_odom_lidar, context.tracker.implied_twist(init.T_odom_lidar)};
    refuted = initial;
  }
  if (context.map.sweeps() == 1) {
    return SecondSweep(context, search).registered(initial, context.tracker.prior(refuted));
  }
  Registration found = refuted ? search.from(initial)
                               : search.to_map(initial, context.tracker.prior(std::nullopt), context.sigma_th_m,
                                               context.config.icp, search.end());
  if (context.tracker.lost() && !context.contradicted) {
    // Within the wide gate the pose is a coarse one, and nothing speaks for another place.
    Registration usual = held(context, search, found);
    if (!context.initial_pose.suspicious(usual.quality) && !newly_degenerate(context, usual)) {
      return usual;
    }
  }
  try_other_starts(context, search, predicted, refuted, found);
  if (context.initial_pose.suspicious(found.quality) || newly_degenerate(context, found)) {
    found.cut = search.end().passed();
    if (!found.cut) {
      PathSearch(context, search).improve(predicted, found);
    }
  }
  return context.tracker.lost() ? held(context, search, found) : std::move(found);
}

}  // namespace rilo
