// The second sweep of a map: with it the velocity of the first is found, too.
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "odometry/optimum.hpp"
#include "odometry/registration_stage.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {
// Starts of the second sweep along the direction that it constrains least. The basin of an optimum on a road is about
// a metre wide.
constexpr double kSecondStepM = 1.25;
constexpr double kSecondSpeed = 37.5;     // m/s, 135 km/h: so far do the starts reach, ...
constexpr double kSecondReachM = 40.0;    // ... but not where two sweeps share too little
constexpr std::size_t kSecondStarts = 2;  // of which so many are tried with all points
}  // namespace

/// The map of the first sweep, compensated for a velocity, if it carries times.
std::optional<LocalMap> RegistrationStage::of_first_sweep(const Vector6d& twist) const {
  if (!parts_.map.first_can_be_compensated()) {
    return std::nullopt;
  }
  return parts_.map.first_compensated(twist, parts_.prepared.scene_range_m, parts_.pose_by_elevation);
}

/// That map, or the present one where the first sweep cannot be compensated.
const LocalMap& RegistrationStage::or_present(const std::optional<LocalMap>& compensated) const {
  return compensated ? *compensated : parts_.map.map();
}

/// Velocity of the first sweep, from its registration to the second one: a sensor that speeds up or turns in between
/// has another. The pose found beside it says nothing, since the first sweep is where the map begins.
Vector6d RegistrationStage::twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const {
  const LocalMap map = parts_.map.of_sweep(parts_.prepared.map_cloud, second.state, parts_.prepared.scene_range_m,
                                           parts_.pose_by_elevation);
  const MotionState start{parts_.tracker.trusted().T_odom_lidar, second.state.twist};
  const IcpResult first = adaptive_icp(parts_.map.first_cloud(), map, start, parts_.tracker.prior_before(second),
                                       sigma_m, searching_, deadline);
  return (first.converged() ? first : second).state.twist;
}

/// The first sweep went into the map as if the sensor had stood still. It is compensated with the velocity that the
/// start implies, then with its own.
Registration RegistrationStage::second_sweep(const MotionState& start, const MotionPrior& first_prior,
                                             int rounds) const {
  Registration found;
  found.icp.state = start;
  found.T_init = start.T_odom_lidar;
  int iterations = 0;
  Vector6d twist = start.twist;
  for (int round = kFirstSweepRounds - rounds; round < kFirstSweepRounds; ++round) {
    if (iterations > 0 && parts_.deadline.passed_after(parts_.first_map_ms)) {
      found.icp.termination = IcpTermination::kTimeLimit;
      break;
    }
    // Each round starts nearer.
    const double sigma_m = std::max(std::ldexp(parts_.sigma_th_m, -round), parts_.config.threshold.floor_m);
    const Deadline round_end = search_end_.after(1.0 / (kFirstSweepRounds - round));
    if (iterations > 0 && parts_.map.first_can_be_compensated()) {
      twist = twist_of_first(found.icp, sigma_m, round_end.after(0.5));
    }
    found.first = FirstSweep{of_first_sweep(twist), twist};
    const MotionPrior prior = iterations == 0 ? first_prior : parts_.tracker.prior(found.icp.state);
    found.icp = adaptive_icp(parts_.prepared.source, or_present(found.first->map), found.icp.state, prior, sigma_m,
                             searching_, round_end);
    iterations += found.icp.iterations;
  }
  found.icp.iterations = iterations;
  rate(found, or_present(found.first->map));
  return found;
}

/// No motion is known at the second sweep, and along a road it has several optima: at rest, too, when most of what it
/// sees runs along the road or drives with the sensor. Registers a sample of it from places along the direction that
/// it constrains least; the best results that lie elsewhere than `found` and each other, best first.
std::vector<MotionState> RegistrationStage::other_second_starts(const Registration& found) const {
  const TimedCloud sample = every_nth(parts_.prepared.source, kSparseStride);
  const Eigen::Matrix3d information = found.icp.lidar_information.bottomRightCorner<3, 3>();
  const Eigen::Vector3d weakest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors().col(0);
  std::vector<MotionState> places;
  const double reach_m = std::min(kSecondSpeed * parts_.tracker.since_trusted_s(), kSecondReachM);
  const auto steps = static_cast<int>(std::lround(reach_m / kSecondStepM));
  for (int k = -steps; k <= steps; ++k) {
    SE3 place = parts_.tracker.trusted().T_odom_lidar;
    place.translation() += k * kSecondStepM * weakest;
    places.push_back({place, parts_.tracker.implied_twist(place)});
  }
  std::vector<SampleFit> fits(places.size());
  for_each_index(places.size(), [&](std::size_t i) {
    if (!parts_.deadline.passed_after(parts_.first_map_ms)) {
      fits[i] = fit_of(sample, places[i], or_present(of_first_sweep(places[i].twist)), parts_.deadline);
    }
  });
  // On 155 second sweeps those that won had at least 0.99 of its quality, half of the others less than 0.6.
  const double worth_trying = 1.0 - parts_.config.initial_pose.margin;
  const double least =
      settled(found.icp)
          ? worth_trying * fit_of(sample, found.icp.state, or_present(found.first->map), parts_.deadline).quality
          : 0.0;
  std::stable_sort(fits.begin(), fits.end(),
                   [](const SampleFit& a, const SampleFit& b) { return a.quality > b.quality; });
  std::vector<MotionState> starts = {found.icp.state};
  for (const SampleFit& fit : fits) {
    const SE3& T = fit.state.T_odom_lidar;
    const bool apart = std::all_of(starts.begin(), starts.end(),
                                   [&T](const MotionState& start) { return elsewhere(start.T_odom_lidar, T); });
    if (apart && fit.quality > 0.0 && fit.quality >= least && starts.size() <= kSecondStarts) {
      starts.push_back({T, parts_.tracker.implied_twist(T)});
    }
  }
  starts.erase(starts.begin());
  return starts;
}

}  // namespace rilo
