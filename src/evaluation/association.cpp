#include "evaluation/association.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace rilo {

namespace {

std::vector<std::size_t> order_of_time(const Trajectory& trajectory) {
  std::vector<std::size_t> order(trajectory.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&trajectory](std::size_t a, std::size_t b) {
    return trajectory[a].stamp_ns < trajectory[b].stamp_ns;
  });
  return order;
}

/// |a − b| without overflow, whatever the stamps are.
std::uint64_t gap_ns(std::int64_t a, std::int64_t b) {
  const auto ua = static_cast<std::uint64_t>(a);
  const auto ub = static_cast<std::uint64_t>(b);
  return a > b ? ua - ub : ub - ua;
}

/// Place in `order` of the stamp nearest to `stamp_ns`, the earlier one of two equally near.
std::size_t nearest(const Trajectory& trajectory, const std::vector<std::size_t>& order, std::int64_t stamp_ns) {
  const auto after =
      std::lower_bound(order.begin(), order.end(), stamp_ns,
                       [&trajectory](std::size_t i, std::int64_t stamp) { return trajectory[i].stamp_ns < stamp; });
  const auto place = static_cast<std::size_t>(after - order.begin());
  if (place == 0) return 0;
  if (place == order.size()) return place - 1;
  const std::uint64_t before_gap = gap_ns(stamp_ns, trajectory[order[place - 1]].stamp_ns);
  return before_gap <= gap_ns(stamp_ns, trajectory[order[place]].stamp_ns) ? place - 1 : place;
}

std::string seconds(std::int64_t ns) {
  std::ostringstream text;
  text << static_cast<double>(ns) * 1e-9;
  return text.str();
}

void add_match(const Trajectory& truth, std::size_t i, const Trajectory& estimate, std::size_t j,
               MatchedPoses& matched) {
  matched.truth.push_back(truth[i].T_odom_lidar);
  matched.estimate.push_back(estimate[j].T_odom_lidar);
  matched.estimate_index.push_back(j);
}

}  // namespace

MatchedPoses match_by_stamp(const Trajectory& truth, const Trajectory& estimate, std::int64_t tolerance_ns) {
  if (tolerance_ns < 0) {
    throw std::invalid_argument("the tolerance must not be negative, found " + std::to_string(tolerance_ns) + " ns");
  }
  const std::vector<std::size_t> order = order_of_time(truth);
  std::vector<std::optional<std::size_t>> taken_by(truth.size());  // by place in the order of time
  const auto gap_of = [&](std::size_t place, std::size_t j) {
    return gap_ns(truth[order[place]].stamp_ns, estimate[j].stamp_ns);
  };
  for (std::size_t j = 0; j < estimate.size() && !truth.empty(); ++j) {
    const std::size_t place = nearest(truth, order, estimate[j].stamp_ns);
    std::optional<std::size_t>& holder = taken_by[place];
    if (gap_of(place, j) <= static_cast<std::uint64_t>(tolerance_ns) &&
        (!holder || gap_of(place, j) < gap_of(place, *holder))) {
      holder = j;
    }
  }
  MatchedPoses matched;
  for (std::size_t place = 0; place < order.size(); ++place) {
    if (taken_by[place]) add_match(truth, order[place], estimate, *taken_by[place], matched);
  }
  if (truth.size() < 2 || estimate.size() < 2) {
    throw std::invalid_argument("at least two poses of each are needed, found " + std::to_string(truth.size()) +
                                " true and " + std::to_string(estimate.size()) + " estimated");
  }
  if (matched.truth.size() < 2) {
    throw std::invalid_argument("only " + std::to_string(matched.truth.size()) + " of " +
                                std::to_string(estimate.size()) + " estimated poses have a ground-truth pose within " +
                                seconds(tolerance_ns) + " s; check that both use the same clock");
  }
  return matched;
}

MatchedPoses match_by_index(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.size() != estimate.size() || truth.size() < 2) {
    throw std::invalid_argument("matching by index needs two trajectories of one length of at least two, found " +
                                std::to_string(truth.size()) + " true and " + std::to_string(estimate.size()) +
                                " estimated poses");
  }
  MatchedPoses matched;
  for (std::size_t i = 0; i < truth.size(); ++i) add_match(truth, i, estimate, i, matched);
  return matched;
}

std::vector<SE3> poses_of(const Trajectory& trajectory) {
  std::vector<SE3> poses;
  poses.reserve(trajectory.size());
  for (const StampedPose& stamped : trajectory) poses.push_back(stamped.T_odom_lidar);
  return poses;
}

}  // namespace rilo
