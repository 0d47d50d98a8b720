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
  const std::vector<MotionState> places = other_places(predicted, found);
  if (places.empty()) {
    return;
  }
  const SweepOverlap overlap = overlap_with_last(predicted, found);
  const PointGrid last = overlap.before(parts_.tracker.trusted().motion());
  const auto late = [&] { return looks_end.passed(); };
  const std::vector<double> overlaps = overlaps_of(
      places.size(), [&](std::size_t i) { return overlap.at(places[i], last); }, late);
  found.cut = late();
  if (found.cut) {
    return;
  }
  const MotionState& best = places[most_of(overlaps)];
  const std::vector<double> of_found = overlap.matches(found.icp.state, last);
  if (!clearly_more(overlap.matches(best, last), of_found)) {
    return;
  }
  Registration other = search_.from(best);
  if (!settled(other.icp)) {
    // It may have come a long way, since the sensor has turned or sped up meanwhile.
    other = search_.from(other.icp.state);
  }
  found.starts = other.starts = found.starts + 1;
  if (settled(other.icp) && clearly_more(overlap.matches(other.icp.state, last), of_found)) {
    found = std::move(other);
  } else {
    found.ambiguous = true;
  }
}

/// Where else than it was found the sensor was or will be, so far apart that between two places a match is still 0.6,
/// or, where it turns rather than moves, a period apart; and where the sweep before fitted, had the motion been
/// possible.
std::vector<MotionState> PathSearch::other_places(const MotionState& predicted, const Registration& found) const {
  const double speed_m_s = predicted.twist.tail<3>().norm();
  const double reach_s = std::min(kPeriods * parts_.period_s, SweepOverlap::kReachM / std::max(speed_m_s, 1e-9));
  const double step_s = std::min(parts_.period_s, 2.0 * SweepOverlap::kSigmaM / std::max(speed_m_s, 1e-9));
  const auto steps = static_cast<int>(std::lround(reach_s / step_s));
  std::vector<MotionState> places;
  for (int k = -steps; k <= steps; ++k) {
    const SE3 T = predicted.T_odom_lidar * se3_exp(k * step_s * predicted.twist);
    if (elsewhere(T, found.icp.state.T_odom_lidar)) {
      places.push_back({T, predicted.twist});
    }
  }
  const std::optional<MotionState> claimed = parts_.tracker.predicted_from_claim();
  if (claimed && elsewhere(claimed->T_odom_lidar, found.icp.state.T_odom_lidar)) {
    places.push_back(*claimed);
  }
  return places;
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
