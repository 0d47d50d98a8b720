#include "odometry/path_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "odometry/optimum.hpp"

namespace rilo {

namespace {
// A sweep that fits badly may have been taken so many periods earlier or later than its stamp: the sensor moved on as
// before, so that it lies on the path.
constexpr int kPeriods = 8;
}  // namespace

void PathSearch::improve(const MotionState& predicted, Registration& found) const {
  const Deadline looks_end = search_.end().after(PoseSearch::kTimeShare);
  const std::vector<Place> places = places_of(predicted, found);
  if (std::none_of(places.begin(), places.end(), [](const Place& place) { return place.elsewhere; })) {
    return;
  }
  const SweepOverlap overlap = overlap_with_last(predicted, found);
  const PointGrid last = overlap.before(parts_.tracker.trusted().motion());
  const auto late = [&] { return looks_end.passed(); };
  const std::vector<double> overlaps = overlaps_of(
      places.size(), [&](std::size_t i) { return overlap.at(places[i].state, last); }, late);
  found.cut = late();
  if (found.cut) {
    return;
  }
  const std::vector<double> of_found = overlap.matches(found.icp.state, last);
  const auto more = [&](const MotionState& state) { return clearly_more(overlap.matches(state, last), of_found); };
  const Place* best = best_of(places, overlaps, false);
  const bool clear = best && more(best->state);
  if (!clear) {
    // What the sensor has turned meanwhile hides what the sweeps have in common until one is registered.
    best = parts_.tracker.lost() ? best_of(places, overlaps, true) : nullptr;
    if (!best) {
      return;
    }
  }
  Registration other = search_.from(best->state);
  if (!settled(other.icp)) {
    // It may have come a long way, since the sensor has turned or sped up meanwhile.
    other = search_.from(other.icp.state);
  }
  found.starts = other.starts = found.starts + 1;
  if (settled(other.icp) && more(other.icp.state)) {
    found = std::move(other);
  } else if (clear) {
    found.ambiguous = true;
  }
}

/// Where the sensor was or will be, so far apart that between two places a match is still 0.6, or, where it turns
/// rather than moves, a period apart; at last where the sweep before fitted, had the motion been possible.
std::vector<PathSearch::Place> PathSearch::places_of(const MotionState& predicted, const Registration& found) const {
  const double speed_m_s = predicted.twist.tail<3>().norm();
  const double reach_s = std::min(kPeriods * parts_.period_s, SweepOverlap::kReachM / std::max(speed_m_s, 1e-9));
  const double step_s = std::min(parts_.period_s, 2.0 * SweepOverlap::kSigmaM / std::max(speed_m_s, 1e-9));
  const auto steps = static_cast<int>(std::lround(reach_s / step_s));
  const auto place = [&](const SE3& T) {
    return Place{{T, predicted.twist}, elsewhere(T, found.icp.state.T_odom_lidar)};
  };
  std::vector<Place> places;
  for (int k = -steps; k <= steps; ++k) {
    places.push_back(place(predicted.T_odom_lidar * se3_exp(k * step_s * predicted.twist)));
  }
  if (const std::optional<MotionState> claimed = parts_.tracker.predicted_from_claim()) {
    places.push_back(place(claimed->T_odom_lidar));
  }
  return places;
}

/// The place elsewhere of the most overlap; nullptr where there is none. A peak has more than both of its neighbours.
const PathSearch::Place* PathSearch::best_of(const std::vector<Place>& places, const std::vector<double>& overlaps,
                                             bool peaks) {
  const auto is_peak = [&](std::size_t i) {
    return (i == 0 || overlaps[i] > overlaps[i - 1]) && (i + 1 == places.size() || overlaps[i] > overlaps[i + 1]);
  };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].elsewhere && (!peaks || is_peak(i)) && (!best || overlaps[i] > overlaps[*best])) {
      best = i;
    }
  }
  return best ? &places[*best] : nullptr;
}

/// The sweep as found beside the last one that was accepted.
SweepOverlap PathSearch::overlap_with_last(const MotionState& predicted, const Registration& found) const {
  const LocalMap planes = parts_.map.of_sweep(parts_.prepared.map_cloud, found.icp.state, parts_.prepared.scene_range_m,
                                              parts_.pose_by_elevation);
  return {{parts_.initial_pose.last_source(), parts_.tracker.trusted(), parts_.map.map()},
          {parts_.prepared.source, found.icp.state, planes},
          predicted.twist_in_odom()};
}

}  // namespace rilo
