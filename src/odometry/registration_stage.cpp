#include "odometry/registration_stage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "cloud/deskew.hpp"
#include "cloud/fixed_chunks.hpp"
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

/// How well a registration fits, to be compared on the same points and within the same gate: what fits over how far it
/// is off. The score sees small differences, the correspondences all points.
double quality(const Registration& registration) {
  const IcpResult& icp = registration.icp;
  return icp.residual_rms_m > 0.0 ? registration.score * static_cast<double>(icp.inliers) / icp.residual_rms_m : 0.0;
}

/// Converged without points that had to be held.
bool settled(const Registration& registration) { return registration.icp.converged() && !registration.icp.frozen; }

/// Converged where `other` did not, or without points that `other` had to hold.
bool settles_better(const Registration& registration, const Registration& other) {
  return (registration.icp.converged() && !other.icp.converged()) || (settled(registration) && !settled(other));
}

/// Poses nearer than the noise of good ones: their scores differ by the sample of the score.
bool same_optimum(const Registration& a, const Registration& b) {
  const SE3 between = a.icp.state.T_odom_lidar.inverse() * b.icp.state.T_odom_lidar;
  return between.translation().norm() <= kPoseNoiseM && rotation_angle_rad(between) <= kPoseNoiseRad;
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
    }
  } else if (parts_.initial_pose.suspicious(found.score, found.icp.residual_rms_m)) {
    found.cut = search_end_.passed();
    if (!found.cut) {
      try_all(starts_on_path(predicted), kFirstSweepRounds, found);
      // If only its time is wrong, it moved as its neighbours do, not as the way to it implies.
      try_all({{found.icp.state.T_odom_lidar, predicted.twist}}, kFirstSweepRounds, found);
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
  found.score = parts_.initial_pose.score(parts_.prepared.source, found.icp.state, parts_.map.map());
  return found;
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
  const bool settles = settles_better(other, found) && quality(other) > quality(found);
  if (settles || (!same_optimum(other, found) && quality(other) > margin * quality(found))) {
    found = std::move(other);
  }
}

/// Missing or reordered sweeps lie elsewhere on the path.
std::vector<MotionState> RegistrationStage::starts_on_path(const MotionState& predicted) const {
  std::vector<MotionState> starts;
  for (const SE3& place :
       parts_.initial_pose.places_on_path(parts_.prepared.source, predicted, parts_.period_s, parts_.map.map())) {
    starts.push_back({place, parts_.tracker.implied_twist(place)});
  }
  return starts;
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
      fits[i] = fit_of(sample, places[i], or_present(of_first_sweep(places[i].twist)));
    }
  });
  // On 155 second sweeps those that won had at least 0.99 of its quality, half of the others less than 0.6.
  const double worth_trying = 1.0 - parts_.config.initial_pose.margin;
  const double least =
      settled(found) ? worth_trying * fit_of(sample, found.icp.state, or_present(found.first->map)).quality : 0.0;
  std::stable_sort(fits.begin(), fits.end(),
                   [](const SampleFit& a, const SampleFit& b) { return a.quality > b.quality; });
  std::vector<MotionState> starts = {found.icp.state};
  for (const SampleFit& fit : fits) {
    const bool elsewhere = std::all_of(starts.begin(), starts.end(), [&](const MotionState& start) {
      return (start.T_odom_lidar.translation() - fit.T_odom_lidar.translation()).norm() > 0.5 * kSecondStepM;
    });
    if (elsewhere && fit.quality > 0.0 && fit.quality >= least && starts.size() <= kSecondStarts) {
      starts.push_back({fit.T_odom_lidar, parts_.tracker.implied_twist(fit.T_odom_lidar)});
    }
  }
  starts.erase(starts.begin());
  return starts;
}

RegistrationStage::SampleFit RegistrationStage::fit_of(const TimedCloud& sample, const MotionState& start,
                                                       const LocalMap& map) const {
  Registration fit;
  fit.icp =
      adaptive_icp(sample, map, start, parts_.tracker.prior(start), parts_.sigma_th_m, searching_, parts_.deadline);
  std::vector<Eigen::Vector3f> points;
  deskew(sample, fit.icp.state.motion(), points);
  fit.score = map_score(points, map, fit.icp.state.T_odom_lidar, parts_.config.initial_pose.score_sigma_m);
  return {fit.icp.state.T_odom_lidar, quality(fit)};
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
  found.score = parts_.initial_pose.score(parts_.prepared.source, found.icp.state, or_present(found.first->map));
  return found;
}

}  // namespace rilo
