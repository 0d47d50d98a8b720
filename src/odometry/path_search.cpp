#include "odometry/path_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "geometry/median.hpp"
#include "odometry/health.hpp"
#include "odometry/optimum.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {
// A sweep that fits badly may have been taken so many periods earlier or later than its stamp: the sensor moved on as
// before, so that it lies whole periods away.
constexpr int kPeriods = 8;
// Where a sweep belongs, its quality exceeds that of the surroundings by more than so many times what it does elsewhere
// in the median.
constexpr double kStandsOut = 6.0;

/// Quality of fits over that of the fits beside them.
struct PathProfile {
  std::size_t best = 0;
  double outstanding = 0;  ///< of the best
  double found = 0;        ///< where the sweep was found; 0: no fit ends there
  double noise = 0;        ///< median distance from 1
};

/// Quality of a fit over the mean of the nearest ones on either side that ended elsewhere.
double over_surroundings(const std::vector<SampleFit>& fits, std::size_t k) {
  const auto other = [&](const SampleFit& fit) {
    return elsewhere(fit.state.T_odom_lidar, fits[k].state.T_odom_lidar);
  };
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

/// Quality itself falls with the overlap with the map, and along a motorway it differs by a few per cent only: compared
/// is how far it exceeds that of the surroundings.
PathProfile profile_of(const std::vector<SampleFit>& fits, const Registration& found) {
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
  profile.noise = upper_median(std::span(off));
  return profile;
}
}  // namespace

void PathSearch::improve(const MotionState& predicted, Registration& found) const {
  const Deadline fits_end = search_.end().after(PoseSearch::kTimeShare);
  const std::vector<SampleFit> fits = fits_on_path(predicted, fits_end);
  found.cut = fits_end.passed();
  if (found.cut) {
    return;
  }
  const auto from = [&](const MotionState& start) {
    return search_.to_map(start, parts_.tracker.prior(start), parts_.sigma_th_m, search_.icp(), search_.end());
  };
  const PathProfile profile = profile_of(fits, found);
  const MotionState& best = fits[profile.best].state;
  if (profile.found == 0.0 || !elsewhere(best.T_odom_lidar, found.icp.state.T_odom_lidar)) {
    // Where it was found, it may have moved as its neighbours do, not as the way to it implies.
    if (!is_degenerate(found.icp, parts_.config.health)) {
      search_.keep_better(from(best), found);
    }
    return;
  }
  if (profile.outstanding - std::max(profile.found, 1.0) <= kStandsOut * profile.noise) {
    return;
  }
  Registration other = from(best);
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

/// A sample of the sweep, registered from where the sensor was or will be some periods earlier and later.
std::vector<SampleFit> PathSearch::fits_on_path(const MotionState& predicted, const Deadline& end) const {
  const TimedCloud sample = every_nth(parts_.prepared.source, kSparseStride);
  std::vector<SampleFit> fits(2 * kPeriods + 1);
  for_each_index(fits.size(), [&](std::size_t i) {
    const double later_s = (static_cast<double>(i) - kPeriods) * parts_.period_s;
    const MotionState place{predicted.T_odom_lidar * se3_exp(later_s * predicted.twist), predicted.twist};
    if (!end.passed()) {
      fits[i] = search_.fit_of(sample, place, parts_.map.map(), end);
    }
  });
  return fits;
}

}  // namespace rilo
