#include "odometry/registration_stage.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Eigenvalues>

#include "cloud/deskew.hpp"
#include "cloud/fixed_chunks.hpp"
#include "odometry/health.hpp"
#include "odometry/pose_noise.hpp"
#include "registration/map_score.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {
constexpr int kFirstSweepRounds = 3;  // each compensates the first sweep with the velocity of the round before
constexpr int kNearbyRounds = 2;      // the last ones: the wide gate of the first may leave the basin of the start
// Starts of the second sweep along the direction that it constrains least. The basin of an optimum on a road is about
// a metre wide.
constexpr double kSecondStepM = 1.25;
constexpr double kSecondSpeed = 37.5;     // m/s, 135 km/h: so far do the starts reach, ...
constexpr double kSecondReachM = 40.0;    // ... but not where two sweeps share too little
constexpr std::size_t kSecondStarts = 2;  // of which so many are tried with all points
// Another optimum is so far away.
constexpr double kApartM = 0.5 * kSecondStepM;
constexpr double kApartRad = 0.1;
// A sweep that fits badly may have been taken so many periods earlier or later than its stamp: the sensor moved on as
// before, so that it lies whole periods away.
constexpr int kPeriods = 8;
// Of the quality of a second sweep: one that fits as well elsewhere is not certain. Of 384 that were right, no rival
// reached 0.9.
constexpr double kRival = 0.9;
// Where the velocity is not known, the state may be uncertain by metres along a road. A search then stops at this share
// of the usual bound of convergence, or it would stop on the way.
constexpr double kSearchEpsilon = 0.1;

TimedCloud every(const TimedCloud& cloud, std::size_t stride) {
  TimedCloud sample;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    sample.points.push_back(cloud.points[i]);
    if (cloud.timed()) {
      sample.offsets_s.push_back(cloud.offsets_s[i]);
    }
    if (!cloud.counts.empty()) {
      sample.counts.push_back(cloud.counts[i]);
    }
  }
  return sample;
}

/// What fits over how far it is off. The score sees small differences, the correspondences all points.
double quality_of(const IcpResult& icp, double score, std::size_t points) {
  const double share = static_cast<double>(icp.inliers) / static_cast<double>(points);
  return icp.residual_rms_m > 0.0 ? score * share / icp.residual_rms_m : 0.0;
}

/// Converged without points that had to be held.
bool settled(const IcpResult& icp) { return icp.converged() && !icp.frozen; }

/// Converged where `other` did not, or without points that `other` had to hold.
bool settles_better(const IcpResult& icp, const IcpResult& other) {
  return (icp.converged() && !other.converged()) || (settled(icp) && !settled(other));
}

bool within(const SE3& a, const SE3& b, double metres, double radians) {
  const SE3 between = a.inverse() * b;
  return between.translation().norm() <= metres && rotation_angle_rad(between) <= radians;
}

bool elsewhere(const SE3& a, const SE3& b) { return !within(a, b, kApartM, kApartRad); }

/// Poses nearer than the noise of good ones: their scores differ by the sample of the score.
bool same_optimum(const Registration& a, const Registration& b) {
  return within(a.icp.state.T_odom_lidar, b.icp.state.T_odom_lidar, kPoseNoiseM, kPoseNoiseRad);
}

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
}  // namespace

RegistrationStage::RegistrationStage(const Parts& parts)
    : parts_(parts),
      search_end_(parts.tracker.lost() ? parts.deadline.after(kSearchShare) : parts.deadline),
      searching_(parts.config.icp) {
  searching_.epsilon *= kSearchEpsilon;
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
      try_all(other_second_starts(found), kNearbyRounds, found);
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
  const bool wins = settles || (!same_optimum(other, found) && other.quality > margin * found.quality);
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

/// Missing or reordered sweeps lie elsewhere on the path: where a sample of the sweep stands out there. Quality itself
/// falls with the overlap with the map, and along a motorway it differs by a few per cent only.
void RegistrationStage::try_on_path(const MotionState& predicted, Registration& found) const {
  const Deadline fits_end = search_end_.after(kSearchShare);
  const std::vector<SampleFit> fits = fits_on_path(predicted, fits_end);
  if (fits_end.passed()) {
    found.cut = true;
    return;
  }
  const SampleFit* best = nullptr;
  double best_ratio = 0.0;
  double ratio_found = 0.0;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const double ratio = over_surroundings(fits, k);
    if (!elsewhere(fits[k].state.T_odom_lidar, found.icp.state.T_odom_lidar)) {
      ratio_found = std::max(ratio_found, ratio);
    }
    if (ratio > best_ratio) {
      best_ratio = ratio;
      best = &fits[k];
    }
  }
  const double margin = 1.0 + parts_.config.initial_pose.margin;
  if (best_ratio <= margin * std::max(ratio_found, 1.0) || ratio_found == 0.0) {
    // Where it was found, it may have moved as its neighbours do, not as the way to it implies.
    try_all({best->state}, kFirstSweepRounds, found);
    return;
  }
  Registration other = from(best->state, parts_.tracker.prior(best->state), kFirstSweepRounds, searching_);
  other.starts = found.starts + 1;
  if (settled(other.icp) && !elsewhere(other.icp.state.T_odom_lidar, best->state.T_odom_lidar)) {
    found = std::move(other);
  } else {
    found.ambiguous = true;
  }
}

/// A sample of the sweep, registered from where the sensor was or will be some periods earlier and later.
std::vector<RegistrationStage::SampleFit> RegistrationStage::fits_on_path(const MotionState& predicted,
                                                                          const Deadline& end) const {
  const TimedCloud sample = every(parts_.prepared.source, kSparseStride);
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

/// No motion is known at the second sweep, and along a road it has several optima: at rest, too, when most of what it
/// sees runs along the road or drives with the sensor. Registers a sample of it from places along the direction that
/// it constrains least; the best results that lie elsewhere than `found` and each other, best first.
std::vector<MotionState> RegistrationStage::other_second_starts(const Registration& found) const {
  const TimedCloud sample = every(parts_.prepared.source, kSparseStride);
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

RegistrationStage::SampleFit RegistrationStage::fit_of(const TimedCloud& sample, const MotionState& start,
                                                       const LocalMap& map, const Deadline& deadline) const {
  const IcpResult icp =
      adaptive_icp(sample, map, start, parts_.tracker.prior(start), parts_.sigma_th_m, searching_, deadline);
  std::vector<Eigen::Vector3f> points;
  deskew(sample, icp.state.motion(), points);
  const double score = map_score(points, map, icp.state.T_odom_lidar, parts_.config.initial_pose.score_sigma_m);
  return {icp.state, quality_of(icp, score, sample.size())};
}

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

}  // namespace rilo
