#include "odometry/second_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "cloud/thinning.hpp"
#include "odometry/optimum.hpp"

namespace rilo {

namespace {
constexpr int kRounds = 4;                 // each compensates the first sweep with the velocity of the one before
constexpr double kDraftShare = 1.0 / 3.0;  // of the points; with a quarter fewer second sweeps are certain
constexpr double kMostSpeed = 37.5;        // m/s, 135 km/h: so far other places are looked at
// What moves with the sensor speaks for standing still: rings on the road, raindrops, cars of its own pace.
constexpr double kTimesMoving = 2.0;
constexpr double kTimesAtRest = 4.0;
constexpr int kLooks = 3;                // the first result may be turned, too
constexpr Eigen::Index kDirections = 2;  // of translations, in which other places are looked at
}  // namespace

SecondSweep::SecondSweep(const RegistrationContext& context, const PoseSearch& search)
    : context_(context),
      search_(search),
      source_(thinned(context.prepared.source, kDraftShare)),
      map_cloud_(thinned(context.prepared.map_cloud, kDraftShare)),
      first_(thinned(context.map.first_cloud(), kDraftShare)) {}

Registration SecondSweep::registered(const MotionState& start, const MotionPrior& prior) const {
  Registration found = in_rounds(start, prior, kRounds);
  found.cut = search_.end().passed_after(context_.first_map_ms);
  if (!found.cut) {
    move_to_most_overlap(found);
  }
  return found;
}

/// The map of the first sweep, or of some of its points, compensated for a velocity, if it carries times.
std::optional<LocalMap> SecondSweep::of_first_sweep(const TimedCloud& first, const Vector6d& twist) const {
  if (!context_.map.first_can_be_compensated()) {
    return std::nullopt;
  }
  return context_.map.first_compensated(first, twist, context_.prepared.scene_range_m, context_.pose_by_elevation);
}

/// That map, or the present one where the first sweep cannot be compensated.
const LocalMap& SecondSweep::or_present(const std::optional<LocalMap>& compensated) const {
  return compensated ? *compensated : context_.map.map();
}

/// Velocity of the first sweep, from its registration to the second one: a sensor that speeds up or turns in between
/// has another. The pose found beside it says nothing, since the first sweep is where the map begins.
Vector6d SecondSweep::twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const {
  const LocalMap map = search_.map_of(map_cloud_, second.state);
  const MotionState start{context_.tracker.trusted().T_odom_lidar, second.state.twist};
  const IcpResult first =
      adaptive_icp(first_, map, start, context_.tracker.prior_before(second), sigma_m, search_.icp(), deadline);
  return (first.converged() ? first : second).state.twist;
}

/// A draft takes a share of the time of the last round, which it must leave.
bool SecondSweep::too_late_for_two_rounds() const {
  return context_.deadline.passed_after((1.0 + 2.0 * kDraftShare) * context_.first_map_ms);
}

/// The first sweep went into the map as if the sensor had stood still. It is compensated with the velocity that the
/// start implies, then with its own. All points are in use in the last round alone. From a place that is known to a
/// few centimetres that round is enough: the wider gate of the others, and of points with a stride, takes in what
/// belongs to the place beside it.
Registration SecondSweep::in_rounds(const MotionState& start, const MotionPrior& first_prior, int rounds) const {
  AdaptiveIcpConfig icp = search_.icp();
  if (rounds == 1) {
    icp.coarse_stride = 1;
  }
  Registration found;
  found.icp.state = start;
  found.T_init = start.T_odom_lidar;
  int iterations = 0;
  Vector6d twist = start.twist;
  bool last = false;
  for (int round = kRounds - rounds; !last; ++round) {
    last = too_late_for_two_rounds() || round + 1 == kRounds;
    // Each round starts nearer.
    const double sigma_m = std::max(std::ldexp(context_.sigma_th_m, -round), context_.config.threshold.floor_m);
    const Deadline round_end = search_.end().after(1.0 / (kRounds - round));
    if (iterations > 0 && context_.map.first_can_be_compensated()) {
      twist = twist_of_first(found.icp, sigma_m, round_end.after(0.5));
    }
    found.first = FirstSweep{of_first_sweep(last ? context_.map.first_cloud() : first_, twist), twist};
    const MotionPrior prior = iterations == 0 ? first_prior : context_.tracker.prior(found.icp.state);
    found.icp = adaptive_icp(last ? context_.prepared.source : source_, or_present(found.first->map), found.icp.state,
                             prior, sigma_m, icp, round_end);
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

/// The sweep as found beside the first one.
SweepOverlap SecondSweep::overlap_with_first(const Registration& found) const {
  const LocalMap planes = search_.map_of(context_.prepared.map_cloud, found.icp.state);
  const SE3& origin = context_.tracker.trusted().T_odom_lidar;
  return {{context_.map.first_cloud(), {origin, found.first->twist}, or_present(found.first->map)},
          {context_.prepared.source, found.icp.state, planes}};
}

/// The sensor there instead, with the velocity that this implies.
MotionState SecondSweep::moved(const MotionState& state, const Eigen::Vector3d& by_m) const {
  SE3 T = state.T_odom_lidar;
  T.translation() += by_m;
  return {T, context_.tracker.implied_twist(T)};
}

/// Other places along a direction, as far as a sensor may have moved.
std::vector<MotionState> SecondSweep::places_along(const Registration& found, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d& origin = context_.tracker.trusted().T_odom_lidar.translation();
  const double found_m = direction.dot(found.icp.state.T_odom_lidar.translation() - origin);
  const double reach_m = std::min(kMostSpeed * context_.tracker.since_trusted_s(), SweepOverlap::kReachM);
  const auto steps = [](double way_m) { return static_cast<int>(std::lround(way_m / SweepOverlap::kSigmaM)); };
  std::vector<MotionState> places;
  for (int k = steps(-reach_m - found_m); k <= steps(reach_m - found_m); ++k) {
    if (k != 0) {
      places.push_back(moved(found.icp.state, k * SweepOverlap::kSigmaM * direction));
    }
  }
  return places;
}

/// How many times what speaks for another place must speak for this one.
double SecondSweep::times_asked(const Registration& found) const {
  const SE3& origin = context_.tracker.trusted().T_odom_lidar;
  const double moved_m = (found.icp.state.T_odom_lidar.translation() - origin.translation()).norm();
  return moved_m < SweepOverlap::kSigmaM ? kTimesAtRest : kTimesMoving;
}

/// Compares a place with those along a direction from it; returns the sweep registered where it has more in common with
/// the first one, if there is such a place. `ambiguous` becomes true where it may as well lie elsewhere.
std::optional<Registration> SecondSweep::more_along(const Eigen::Vector3d& direction, SweepOverlap& overlap,
                                                    Registration& found, bool& ambiguous) const {
  Vector6d motion = Vector6d::Zero();
  motion.tail<3>() = direction;
  overlap.look_along(motion);
  const auto matches_of = [&](const Registration& registration) {
    return overlap.matches(registration.icp.state, overlap.before({registration.first->twist}));
  };
  const auto matches_at = [&](const MotionState& place) {
    return overlap.matches(place, overlap.before({place.twist}));
  };
  const auto late = [&] { return context_.deadline.passed_after(context_.first_map_ms); };
  const std::vector<double> of_found = matches_of(found);
  const double here = mean_match(of_found);
  const std::vector<MotionState> places = places_along(found, direction);
  const std::vector<double> overlaps = overlaps_along(
      places.size(), [&](std::size_t i) { return mean_match(matches_at(places[i])); }, late);
  found.cut = late();  // then some places were not looked at
  if (found.cut || places.empty()) {
    return std::nullopt;
  }
  const std::optional<std::size_t> rival =
      most_of(overlaps, [&](std::size_t i) { return elsewhere(places[i].T_odom_lidar, found.icp.state.T_odom_lidar); });
  const std::size_t most = most_of(overlaps);
  const bool more_there = overlaps[most] > here;
  const auto in_doubt = [&](std::size_t other) {
    return !clearly_more(of_found, matches_at(places[other]), times_asked(found));
  };
  // Where nothing shows the way, this is no evidence against a place.
  ambiguous |= here > 0.0 && (more_there || (rival && in_doubt(*rival)));
  if (!more_there) {
    return std::nullopt;
  }
  const Eigen::Vector3d half_step = 0.5 * SweepOverlap::kSigmaM * direction;
  const std::vector<MotionState> around{places[most], moved(places[most], -half_step), moved(places[most], half_step)};
  const MotionState& there = around[most_of(overlaps_of(
      around.size(), [&](std::size_t i) { return mean_match(matches_at(around[i])); }, late))];
  Registration other = in_rounds(there, context_.tracker.prior(there), 1);
  other.starts = ++found.starts;
  return mean_match(matches_of(other)) > here ? std::optional(std::move(other)) : std::nullopt;
}

/// No motion is known at the second sweep, and along a road it has several optima: at rest, too, when most of what it
/// sees runs along the road, moves with the sensor as its rings on the ground do, or drives with it. Registers it again
/// from where the two sweeps have most in common along a direction that the first result constrains little, until that
/// is where it ends. In a narrow window the way may lie along the second of these directions: turning there passes for
/// a motion to the side, which is the first.
void SecondSweep::move_to_most_overlap(Registration& found) const {
  const Eigen::Matrix3d information = found.icp.lidar_information.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d weakest_first = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors();
  for (int look = 0; look < kLooks; ++look) {
    SweepOverlap overlap = overlap_with_first(found);
    std::optional<Registration> other;
    bool ambiguous = false;
    for (Eigen::Index i = 0; i < kDirections && !other && !found.cut; ++i) {
      other = more_along(weakest_first.col(i), overlap, found, ambiguous);
    }
    if (!other) {
      // Where time ran out, the doubt from before stays.
      found.ambiguous = ambiguous || (found.cut && found.ambiguous);
      return;
    }
    found = std::move(*other);
    found.ambiguous = true;  // until it was looked at
  }
}

}  // namespace rilo
