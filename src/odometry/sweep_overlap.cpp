#include "odometry/sweep_overlap.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <vector>

#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "cloud/voxel_sampler.hpp"

namespace rilo {

namespace {
constexpr double kPlaceM = 1.0;            // edge of a place
constexpr std::size_t kMostPlaces = 1000;  // enough to tell shares a tenth apart
constexpr double kTellsApart = 0.3;        // least cosine between a normal and the direction of a motion that it shows
constexpr double kReachSigmas = 3.0;
constexpr double kCellReaches = 2.0;  // then what lies within reach of a point lies in eight cells
constexpr double kSigmas = 3.0;       // of the difference of two overlaps, if it is to be none of chance

/// One point a voxel, of surfaces that show the motion or of none.
TimedCloud telling(const SweepOverlap::Seen& seen, const Vector6d& motion, double voxel_m) {
  std::vector<Eigen::Vector3f> points;
  deskew(seen.cloud, seen.state.motion(), points);
  VoxelSampler sampler;
  const std::vector<std::uint32_t>& sampled = sampler.sample(points, voxel_m);
  const auto point_at = [&](std::size_t k) -> Eigen::Vector3d {
    return seen.state.T_odom_lidar * points[sampled[k]].cast<double>();
  };
  const auto way_of = [&](const Eigen::Vector3d& place) -> Eigen::Vector3d {
    return motion.tail<3>() + motion.head<3>().cross(place - seen.state.T_odom_lidar.translation());
  };
  std::vector<char> tells(sampled.size(), 0);
  const auto look_at = [&](std::size_t k, const Eigen::Vector3d& place, const PlaneSpot& spot) {
    const Eigen::Vector3d way = way_of(place);
    const bool along = !spot.scatter && std::abs(spot.grid->plane_at(spot).normal.dot(way)) < kTellsApart * way.norm();
    tells[k] = along ? 0 : 1;
  };
  for_fixed_chunks(sampled.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    seen.planes.visit<LocalMap::Wanted::kPlanesAndScatter>(first, last, point_at, look_at);
  });
  TimedCloud kept;
  for (std::size_t k = 0; k < sampled.size(); ++k) {
    if (tells[k] == 0) {
      continue;
    }
    kept.points.push_back(seen.cloud.points[sampled[k]]);
    if (seen.cloud.timed()) {
      kept.offsets_s.push_back(seen.cloud.offsets_s[sampled[k]]);
    }
  }
  return kept;
}
}  // namespace

SweepOverlap::SweepOverlap(const Seen& before, const Seen& sweep, const Vector6d& motion)
    : T_odom_before_(before.state.T_odom_lidar) {
  for_each_index(2, [&](std::size_t i) {
    if (i == 0) {
      before_ = telling(before, motion, kSigmaM);
    } else {
      places_ = telling(sweep, motion, kPlaceM);
    }
  });
  if (places_.size() > kMostPlaces) {
    places_ = thinned(places_, static_cast<double>(kMostPlaces) / static_cast<double>(places_.size()));
  }
}

PointGrid SweepOverlap::before(const BodyMotion& motion) const {
  std::vector<Eigen::Vector3f> points;
  deskew(before_, motion, points);
  PointGrid grid(kCellReaches * kReachSigmas * kSigmaM);
  grid.build(points);
  return grid;
}

std::vector<double> SweepOverlap::matches(const MotionState& state, const PointGrid& before) const {
  std::vector<Eigen::Vector3f> points;
  deskew(places_, state.motion(), points);
  const Eigen::Isometry3f T_before_lidar = (T_odom_before_.inverse() * state.T_odom_lidar).cast<float>();
  constexpr double kScale = -0.5 / (kSigmaM * kSigmaM);
  std::vector<double> matches(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Neighbour nearest;
    if (before.nearest(T_before_lidar * points[i], kReachSigmas * kSigmaM, nearest)) {
      matches[i] = std::exp(kScale * static_cast<double>(nearest.distance2));
    }
  }
  return matches;
}

double mean_match(std::span<const double> matches) {
  const double sum = std::accumulate(matches.begin(), matches.end(), 0.0);
  return matches.empty() ? 0.0 : sum / static_cast<double>(matches.size());
}

std::vector<double> overlaps_of(std::size_t count, const std::function<double(std::size_t)>& overlap_at,
                                const std::function<bool()>& late) {
  std::vector<double> overlaps(count);
  std::atomic<bool> over = false;
  for_each_index(count, [&](std::size_t i) {
    over = over || late();
    if (!over) {
      overlaps[i] = overlap_at(i);
    }
  });
  return overlaps;
}

std::size_t most_of(const std::vector<double>& overlaps) {
  return static_cast<std::size_t>(std::max_element(overlaps.begin(), overlaps.end()) - overlaps.begin());
}

std::optional<std::size_t> most_of(const std::vector<double>& overlaps,
                                   const std::function<bool(std::size_t)>& allowed) {
  std::optional<std::size_t> most;
  for (std::size_t i = 0; i < overlaps.size(); ++i) {
    if (allowed(i) && (!most || overlaps[i] > overlaps[*most])) {
      most = i;
    }
  }
  return most;
}

bool clearly_more(std::span<const double> most, std::span<const double> others) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < most.size(); ++i) {
    const double difference = most[i] - others[i];
    sum += difference;
    squares += difference * difference;
  }
  return sum > kSigmas * std::sqrt(squares);
}

}  // namespace rilo
