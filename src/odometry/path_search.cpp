#include "odometry/path_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "odometry/optimum.hpp"

namespace rilo {

namespace {
// A sweep that fits badly may have been taken so many periods earlier or later than its stamp: the sensor moved on as
// before, so that it lies on the path.
constexpr int kPeriods = 8;

/// More than both of its neighbours on the path; the place of a claim, where the sweep before fitted, had the motion
/// been possible, has none.
bool is_peak(std::span<const double> on_path, std::size_t i) {
  return i >= on_path.size() ||
         ((i == 0 || on_path[i] > on_path[i - 1]) && (i + 1 == on_path.size() || on_path[i] > on_path[i + 1]));
}
}  // namespace

void PathSearch::improve(const MotionState& predicted, Registration& found) const {
  const Deadline looks_end = search_.end().after(PoseSearch::kTimeShare);
  std::vector<MotionState> places = path_of(predicted);
  const std::size_t path_size = places.size();
  if (const std::optional<MotionState> claimed = context_.tracker.predicted_from_claim()) {
    places.push_back(*claimed);
  }
  const SE3 T_found = found.icp.state.T_odom_lidar;
  const auto is_elsewhere = [&](const MotionState& place) { return elsewhere(place.T_odom_lidar, T_found); };
  if (std::none_of(places.begin(), places.end(), is_elsewhere)) {
    return;
  }
  const SweepOverlap overlap = overlap_with_last(predicted, found);
  const PointGrid last = overlap.before(context_.tracker.trusted().motion());
  const auto late = [&] { return looks_end.passed(); };
  const std::vector<double> overlaps = overlaps_of(
      places.size(), [&](std::size_t i) { return overlap.at(places[i], last); }, late);
  found.cut = late();
  if (found.cut) {
    return;
  }
  const std::vector<double> of_found = overlap.matches(found.icp.state, last);
  const auto more = [&](const MotionState& state) { return clearly_more(overlap.matches(state, last), of_found); };
  std::optional<std::size_t> best = most_of(overlaps, [&](std::size_t i) { return is_elsewhere(places[i]); });
  const bool clear = best && more(places[*best]);
  if (!clear) {
    // What the sensor has turned meanwhile hides what the sweeps have in common until one is registered.
    const auto on_path = std::span(overlaps).first(path_size);
    const auto tried = [&](std::size_t i) { return is_elsewhere(places[i]) && is_peak(on_path, i); };
    best = context_.tracker.lost() ? most_of(overlaps, tried) : std::nullopt;
  }
  if (!best) {
    return;
  }
  Registration there = registered_from(places[*best]);
  found.starts = there.starts = found.starts + 1;
  if (settled(there.icp) && more(there.icp.state)) {
    found = std::move(there);
  } else if (clear) {
    found.ambiguous = true;
  }
}

/// It may come a long way, since the sensor has turned or sped up meanwhile: once more from where it ends.
Registration PathSearch::registered_from(const MotionState& place) const {
  Registration there = search_.from(place);
  return settled(there.icp) ? there : search_.from(there.icp.state);
}

/// Where the sensor was or will be, so far apart that between two places a match is still 0.6, or, where it turns
/// rather than moves, a period apart.
std::vector<MotionState> PathSearch::path_of(const MotionState& predicted) const {
  const double speed_m_s = predicted.twist.tail<3>().norm();
  const double reach_s = std::min(kPeriods * context_.period_s, SweepOverlap::kReachM / std::max(speed_m_s, 1e-9));
  const double step_s = std::min(context_.period_s, 2.0 * SweepOverlap::kSigmaM / std::max(speed_m_s, 1e-9));
  const auto steps = static_cast<int>(std::lround(reach_s / step_s));
  std::vector<MotionState> places;
  for (int k = -steps; k <= steps; ++k) {
    places.push_back({predicted.T_odom_lidar * se3_exp(k * step_s * predicted.twist), predicted.twist});
  }
  return places;
}

/// The sweep as found beside the last one that was accepted.
SweepOverlap PathSearch::overlap_with_last(const MotionState& predicted, const Registration& found) const {
  const LocalMap planes = search_.map_of(context_.prepared.map_cloud, found.icp.state);
  SweepOverlap overlap({context_.initial_pose.last_source(), context_.tracker.trusted(), context_.map.map()},
                       {context_.prepared.source, found.icp.state, planes});
  overlap.look_along(predicted.twist_in_odom());
  return overlap;
}

}  // namespace rilo
