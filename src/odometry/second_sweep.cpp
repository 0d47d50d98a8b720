#include "odometry/second_sweep.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "odometry/optimum.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {
constexpr int kRounds = 4;                 // each compensates the first sweep with the velocity of the one before
constexpr int kNearbyRounds = 2;           // the last ones: the wide gate of the first may leave the basin of the start
constexpr double kDraftShare = 1.0 / 3.0;  // of the points; with a quarter fewer second sweeps are certain
// Starts of the second sweep along the direction that it constrains least, a basin apart.
constexpr double kMostSpeed = 37.5;      // m/s, 135 km/h: so far do the starts reach, ...
constexpr double kReachM = 40.0;         // ... but not where two sweeps share too little
constexpr std::size_t kOtherStarts = 4;  // of which so many are tried again, ...
constexpr double kWorthTrying = 0.8;     // ... from where a sample fits so many times as well as at the first result: a
                                         // wrong one that is not compared with the right one would be vouched for
}  // namespace

SecondSweep::SecondSweep(const RegistrationParts& parts, const PoseSearch& search)
    : parts_(parts),
      search_(search),
      source_(thinned(parts.prepared.source, kDraftShare)),
      map_cloud_(thinned(parts.prepared.map_cloud, kDraftShare)),
      first_(thinned(parts.map.first_cloud(), kDraftShare)) {}

Registration SecondSweep::registered(const MotionState& start, const MotionPrior& prior) const {
  Registration found = in_rounds(start, prior, kRounds);
  found.cut = search_.end().passed_after(parts_.first_map_ms);
  if (!found.cut) {
    const std::vector<MotionState> starts = other_starts(found);
    found.cut = parts_.deadline.passed_after(parts_.first_map_ms);  // then some were not tried with the sample
    const auto from = [&](const MotionState& other) {
      return in_rounds(other, parts_.tracker.prior(other), kNearbyRounds);
    };
    search_.try_all(starts, from, found);
    found.ambiguous = found.rival_quality > kFitsWorse * found.quality;
  }
  return found;
}

/// The map of the first sweep, or of some of its points, compensated for a velocity, if it carries times.
std::optional<LocalMap> SecondSweep::of_first_sweep(const TimedCloud& first, const Vector6d& twist) const {
  if (!parts_.map.first_can_be_compensated()) {
    return std::nullopt;
  }
  return parts_.map.first_compensated(first, twist, parts_.prepared.scene_range_m, parts_.pose_by_elevation);
}

/// That map, or the present one where the first sweep cannot be compensated.
const LocalMap& SecondSweep::or_present(const std::optional<LocalMap>& compensated) const {
  return compensated ? *compensated : parts_.map.map();
}

/// Velocity of the first sweep, from its registration to the second one: a sensor that speeds up or turns in between
/// has another. The pose found beside it says nothing, since the first sweep is where the map begins.
Vector6d SecondSweep::twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const {
  const LocalMap map =
      parts_.map.of_sweep(map_cloud_, second.state, parts_.prepared.scene_range_m, parts_.pose_by_elevation);
  const MotionState start{parts_.tracker.trusted().T_odom_lidar, second.state.twist};
  const IcpResult first =
      adaptive_icp(first_, map, start, parts_.tracker.prior_before(second), sigma_m, search_.icp(), deadline);
  return (first.converged() ? first : second).state.twist;
}

/// The first sweep went into the map as if the sensor had stood still. It is compensated with the velocity that the
/// start implies, then with its own. All points are in use in the last round alone.
Registration SecondSweep::in_rounds(const MotionState& start, const MotionPrior& first_prior, int rounds) const {
  Registration found;
  found.icp.state = start;
  found.T_init = start.T_odom_lidar;
  int iterations = 0;
  Vector6d twist = start.twist;
  bool last = false;
  for (int round = kRounds - rounds; !last; ++round) {
    // A draft takes a share of the time of the last round, which it must leave.
    const bool late = parts_.deadline.passed_after((1.0 + 2.0 * kDraftShare) * parts_.first_map_ms);
    last = late || round + 1 == kRounds;
    // Each round starts nearer.
    const double sigma_m = std::max(std::ldexp(parts_.sigma_th_m, -round), parts_.config.threshold.floor_m);
    const Deadline round_end = search_.end().after(1.0 / (kRounds - round));
    if (iterations > 0 && parts_.map.first_can_be_compensated()) {
      twist = twist_of_first(found.icp, sigma_m, round_end.after(0.5));
    }
    found.first = FirstSweep{of_first_sweep(last ? parts_.map.first_cloud() : first_, twist), twist};
    const MotionPrior prior = iterations == 0 ? first_prior : parts_.tracker.prior(found.icp.state);
    found.icp = adaptive_icp(last ? parts_.prepared.source : source_, or_present(found.first->map), found.icp.state,
                             prior, sigma_m, search_.icp(), round_end);
    found.sigma_th_m = sigma_m;
    iterations += found.icp.iterations;
    if (last && round + 1 < kRounds) {
      found.icp.termination = IcpTermination::kTimeLimit;
    }
  }
  found.icp.iterations = iterations;
  search_.rate(found, or_present(found.first->map));
  return found;
}

/// No motion is known at the second sweep, and along a road it has several optima: at rest, too, when most of what it
/// sees runs along the road or drives with the sensor. Registers a sample of it from places along the direction that
/// it constrains least; the best results that lie elsewhere than `found` and each other, best first.
std::vector<MotionState> SecondSweep::other_starts(const Registration& found) const {
  const TimedCloud sample = every_nth(parts_.prepared.source, kSparseStride);
  const Eigen::Matrix3d information = found.icp.lidar_information.bottomRightCorner<3, 3>();
  const Eigen::Vector3d weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors().col(0);
  // The result first, which the others are compared with; it takes the place of the one beside it.
  std::vector<MotionState> places = {{found.icp.state.T_odom_lidar, found.first->twist}};
  const double reach_m = std::min(kMostSpeed * parts_.tracker.since_trusted_s(), kReachM);
  const auto steps = static_cast<int>(std::lround(reach_m / kBasinM));
  for (int k = -steps; k <= steps; ++k) {
    SE3 place = parts_.tracker.trusted().T_odom_lidar;
    place.translation() += k * kBasinM * weakest;
    if ((place.translation() - found.icp.state.T_odom_lidar.translation()).norm() > 0.5 * kBasinM) {
      places.push_back({place, parts_.tracker.implied_twist(place)});
    }
  }
  std::vector<SampleFit> fits(places.size());
  for_each_index(places.size(), [&](std::size_t i) {
    if (!parts_.deadline.passed_after(parts_.first_map_ms)) {
      fits[i] = search_.fit_of(sample, places[i], or_present(of_first_sweep(first_, places[i].twist)), parts_.deadline);
    }
  });
  const double least = settled(found.icp) ? kWorthTrying * fits.front().quality : 0.0;
  std::stable_sort(fits.begin(), fits.end(),
                   [](const SampleFit& a, const SampleFit& b) { return a.quality > b.quality; });
  std::vector<MotionState> starts = {found.icp.state};
  for (const SampleFit& fit : fits) {
    const SE3& T = fit.state.T_odom_lidar;
    const bool apart = std::all_of(starts.begin(), starts.end(),
                                   [&T](const MotionState& start) { return elsewhere(start.T_odom_lidar, T); });
    if (apart && fit.quality > 0.0 && fit.quality >= least && starts.size() <= kOtherStarts) {
      starts.push_back({T, parts_.tracker.implied_twist(T)});
    }
  }
  starts.erase(starts.begin());
  return starts;
}

}  // namespace rilo
