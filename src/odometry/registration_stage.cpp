#include "odometry/registration_stage.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cloud/deskew.hpp"
#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "odometry/health.hpp"
#include "odometry/optimum.hpp"
#include "registration/map_score.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {
// A sweep that fits badly may have been taken so many periods earlier or later than its stamp: the sensor moved on as
// before, so that it lies whole periods away.
constexpr int kPeriods = 8;
// Where a sweep belongs, its quality exceeds that of the surroundings by more than so many times what it does elsewhere
// in the median.
constexpr double kStandsOut = 6.0;
// Of the quality of a second sweep: one that fits as well elsewhere is not certain. None of 304 right ones has a rival
// of 0.9.
constexpr double kRival = 0.9;
// Where the velocity is not known, the state may be uncertain by metres along a road. A search then stops at this share
// of the usual bound of convergence, or it would stop on the way.
constexpr double kSearchEpsilon = 0.1;

/// Quality of a fit over the mean of the nearest ones on either side that ended elsewhere.
template <typename Fit>
double over_surroundings(const std::vector<Fit>& fits, std::size_t k) {
  const auto other = [&](const Fit& fit) { return elsewhere(fit.state.T_odom_lidar, fits[k].state.T_odom_lidar); };
  const auto at = fits.begin() + static_cast<std::ptrdiff_t>(k);
  double sum = 0.0;
  int sides = 0;
  if (const auto after = std::find_if(at, fits.end(), other); after != fits.end()) {
    sum += after->quality;
    ++sides;
  }
  if (const auto before = std::find_if(std::make_reverse_iterator(at), fits.rend(), other); before != fits.rend()) {
    sum += before->quality;
    ++sides;
  }
  return sum > 0.0 ? sides * at->quality / sum : 1.0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
}  // namespace

RegistrationStage::RegistrationStage(const Parts& parts)
    : parts_(parts),
      search_end_(parts.tracker.lost() ? parts.deadline.after(kSearchShare) : parts.deadline),
      searching_(parts.config.icp) {
  searching_.epsilon *= kSearchEpsilon;
  if (parts_.map.sweeps() == 1) {
    draft_ = {thinned(parts_.prepared.source, kDraftShare), thinned(parts_.prepared.map_cloud, kDraftShare),
              thinned(parts_.map.first_cloud(), kDraftShare)};
  }
}

Registration RegistrationStage::run(const MotionState& predicted, const InitialPose& init) const {
  MotionState initial = predicted;
  std::optional<MotionState> refuted;
  if (init.source == InitialPoseSource::kCoarse || parts_.tracker.lost()) {
    // The sweep has just refuted the prediction: start where it fits, with the velocity that this implies.
    initial = {init.T_odom_lidar, parts_.tracker.implied_twist(init.T_odom_lidar)};
    refuted = initial;
  }
  Registration found =
      from(initial, parts_.tracker.prior(refuted), kFirstSweepRounds, refuted ? searching_ : parts_.config.icp);
  if (parts_.map.sweeps() == 1) {
    found.cut = search_end_.passed_after(parts_.first_map_ms);
    if (!found.cut) {
      const std::vector<MotionState> starts = other_second_starts(found);
      found.cut = parts_.deadline.passed_after(parts_.first_map_ms);  // then some were not tried with the sample
      try_all(starts, kNearbyRounds, found);
      found.ambiguous = found.rival_quality > kRival * found.quality;
    }
  } else if (parts_.initial_pose.suspicious(found.quality) || newly_degenerate(found)) {
    found.cut = search_end_.passed();
    if (!found.cut) {
      try_on_path(predicted, found);
    }
  }
  if (parts_.tracker.lost() && parts_.map.sweeps() > 1) {
    // What was found within a wide gate has to hold within the usual one.
    Registration held = to_map(found.icp.state, parts_.tracker.prior(found.icp.state), parts_.usual_sigma_th_m,
                               searching_, parts_.deadline);
    held.T_init = found.T_init;
    held.starts = found.starts;
    held.cut = found.cut;
    held.ambiguous = found.ambiguous;
    found = std::move(held);
  }
  return found;
}

/// A direction that was seen is no longer: where a sweep does not belong, what shows that direction finds no match.
bool RegistrationStage::newly_degenerate(const Registration& found) const {
  return is_degenerate(found.icp, parts_.config.health) && !parts_.tracker.degenerate();
}

/// A second sweep in so many rounds.
Registration RegistrationStage::from(const MotionState& start, const MotionPrior& prior, int rounds,
                                     const AdaptiveIcpConfig& icp) const {
  return parts_.map.sweeps() == 1 ? second_sweep(start, prior, rounds)
                                  : to_map(start, prior, parts_.sigma_th_m, icp, search_end_);
}

Registration RegistrationStage::to_map(const MotionState& start, const MotionPrior& prior, double sigma_th_m,
                                       const AdaptiveIcpConfig& icp, const Deadline& deadline) const {
  Registration found;
  found.icp = adaptive_icp(parts_.prepared.source, parts_.map.map(), start, prior, sigma_th_m, icp, deadline);
  found.T_init = start.T_odom_lidar;
  rate(found, parts_.map.map());
  return found;
}

void RegistrationStage::rate(Registration& found, const LocalMap& map) const {
  found.score = parts_.initial_pose.score(parts_.prepared.source, found.icp.state, map);
  found.quality = quality_of(found.icp, found.score, parts_.prepared.source.size());
}

/// Registers from further starts while there is time.
void RegistrationStage::try_all(const std::vector<MotionState>& starts, int rounds, Registration& found) const {
  int tried = found.starts;
  bool cut = found.cut;
  for (const MotionState& start : starts) {
    cut = cut || search_end_.passed();
    if (cut) {
      break;
    }
    try_from(start, rounds, found);
    ++tried;
  }
  found.starts = tried;
  found.cut = cut;
}

/// Registers from another start and keeps what ends elsewhere and fits clearly better, or settles where `found` did
/// not.
void RegistrationStage::try_from(const MotionState& start, int rounds, Registration& found) const {
  Registration other = from(start, parts_.tracker.prior(start), rounds, searching_);
  const double margin = 1.0 + parts_.config.initial_pose.margin;
  const bool settles = settles_better(other.icp, found.icp) && other.quality > found.quality;
  const bool wins = settles || (!same_optimum(other.icp.state.T_odom_lidar, found.icp.state.T_odom_lidar) &&
                                other.quality > margin * found.quality);
  Registration& kept = wins ? other : found;
  const Registration& rest = wins ? found : other;
  kept.rival_quality = std::max(found.rival_quality, other.rival_quality);
  if (settled(rest.icp) && elsewhere(rest.icp.state.T_odom_lidar, kept.icp.state.T_odom_lidar)) {
    kept.rival_quality = std::max(kept.rival_quality, rest.quality);
  }
  if (wins) {
    found = std::move(other);
  }
}

/// Missing or reordered sweeps lie elsewhere on the path: where a sample of the sweep stands out there.
void RegistrationStage::try_on_path(const MotionState& predicted, Registration& found) const {
  const Deadline fits_end = search_end_.after(kSearchShare);
  const std::vector<SampleFit> fits = fits_on_path(predicted, fits_end);
  found.cut = fits_end.passed();
  if (found.cut) {
    return;
  }
  const PathProfile profile = profile_of(fits, found);
  const MotionState& best = fits[profile.best].state;
  if (profile.found == 0.0 || !elsewhere(best.T_odom_lidar, found.icp.state.T_odom_lidar)) {
    // Where it was found, it may have moved as its neighbours do, not as the way to it implies.
    if (!is_degenerate(found.icp, parts_.config.health)) {
      try_all({best}, kFirstSweepRounds, found);
    }
    return;
  }
  if (profile.outstanding - std::max(profile.found, 1.0) <= kStandsOut * profile.noise) {
    return;
  }
  Registration other = to_map(best, parts_.tracker.prior(best), parts_.sigma_th_m, searching_, search_end_);
  found.starts = other.starts = found.starts + 1;
  if (is_degenerate(other.icp, parts_.config.health)) {
    return;  // nothing shows that it belongs there: along a tunnel noise stands out, too
  }
  if (settled(other.icp) && !elsewhere(other.icp.state.T_odom_lidar, best.T_odom_lidar)) {
    found = std::move(other);
  } else {
    found.ambiguous = true;
  }
}

/// Quality itself falls with the overlap with the map, and along a motorway it differs by a few per cent only: compared
/// is how far it exceeds that of the surroundings.
RegistrationStage::PathProfile RegistrationStage::profile_of(const std::vector<SampleFit>& fits,
                                                             const Registration& found) {
  PathProfile profile;
  std::vector<double> off;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const double ratio = over_surroundings(fits, k);
    off.push_back(std::abs(ratio - 1.0));
    if (!elsewhere(fits[k].state.T_odom_lidar, found.icp.state.T_odom_lidar)) {
      profile.found = std::max(profile.found, ratio);
    }
    if (ratio > profile.outstanding) {
      profile.outstanding = ratio;
      profile.best = k;
    }
  }
  profile.noise = median(off);
  return profile;
}

/// A sample of the sweep, registered from where the sensor was or will be some periods earlier and later.
std::vector<RegistrationStage::SampleFit> RegistrationStage::fits_on_path(const MotionState& predicted,
                                                                          const Deadline& end) const {
  const TimedCloud sample = every_nth(parts_.prepared.source, kSparseStride);
  std::vector<SampleFit> fits(2 * kPeriods + 1);
  for_each_index(fits.size(), [&](std::size_t i) {
    const double later_s = (static_cast<double>(i) - kPeriods) * parts_.period_s;
    const MotionState place{predicted.T_odom_lidar * se3_exp(later_s * predicted.twist), predicted.twist};
    if (!end.passed()) {
      fits[i] = fit_of(sample, place, parts_.map.map(), end);
    }
  });
  return fits;
}

RegistrationStage::SampleFit RegistrationStage::fit_of(const TimedCloud& sample, const MotionState& start,
                                                       const LocalMap& map, const Deadline& deadline) const {
  const IcpResult icp =
      adaptive_icp(sample, map, start, parts_.tracker.prior(start), parts_.sigma_th_m, searching_, deadline);
  std::vector<Eigen::Vector3f> points;
  deskew(sample, icp.state.motion(), points);
  const double score = map_score(points, map, icp.state.T_odom_lidar, parts_.config.initial_pose.score_sigma_m);
  return {icp.state, quality_of(icp, score, sample.size())};
}

}  // namespace rilo
