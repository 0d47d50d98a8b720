#include "odometry/sweep_overlap.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <set>
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
constexpr std::size_t kLookedBeside = 4;  // places of a row, at both sides
constexpr double kCellReaches = 2.0;      // then what lies within reach of a point lies in eight cells
constexpr double kSigmas = 3.0;           // of the difference of two overlaps, if it is to be none of chance

/// Its place and time.
void append_point(const TimedCloud& from, std::size_t i, TimedCloud& to) {
  to.points.push_back(from.points[i]);
  if (from.timed()) {
    to.offsets_s.push_back(from.offsets_s[i]);
  }
}
}  // namespace

SweepOverlap::Surfaces SweepOverlap::surfaces_of(const Seen& seen, double voxel_m) {
  std::vector<Eigen::Vector3f> points;
  deskew(seen.cloud, seen.state.motion(), points);
  VoxelSampler sampler;
  const std::vector<std::uint32_t>& sampled = sampler.sample(points, voxel_m);
  const SE3& T = seen.state.T_odom_lidar;
  const auto point_at = [&](std::size_t k) -> Eigen::Vector3d { return T * points[sampled[k]].cast<double>(); };
  struct Spot {
    Eigen::Vector3d from_sensor;
    Eigen::Vector3d normal;
    bool of_surface = false;
  };
  std::vector<Spot> spots(sampled.size());
  const auto look_at = [&](std::size_t k, const Eigen::Vector3d& place, const PlaneSpot& spot) {
    const Eigen::Vector3d normal = spot.scatter ? Eigen::Vector3d::Zero() : spot.grid->plane_at(spot).normal;
    spots[k] = {place - T.translation(), normal, true};
  };
  for_fixed_chunks(sampled.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    seen.planes.visit<LocalMap::Wanted::kPlanesAndScatter>(first, last, point_at, look_at);
  });
  Surfaces surfaces;
  for (std::size_t k = 0; k < sampled.size(); ++k) {
    if (!spots[k].of_surface) {
      continue;
    }
    append_point(seen.cloud, sampled[k], surfaces.cloud);
    surfaces.from_sensor.push_back(spots[k].from_sensor);
    surfaces.normals.push_back(spots[k].normal);
  }
  return surfaces;
}

/// Of surfaces that show the motion or of none.
TimedCloud SweepOverlap::telling(const Surfaces& surfaces, const Vector6d& motion) {
  TimedCloud kept;
  for (std::size_t k = 0; k < surfaces.cloud.size(); ++k) {
    const Eigen::Vector3d way = motion.tail<3>() + motion.head<3>().cross(surfaces.from_sensor[k]);
    const Eigen::Vector3d& normal = surfaces.normals[k];
    if (!normal.isZero() && std::abs(normal.dot(way)) < kTellsApart * way.norm()) {
      continue;
    }
    append_point(surfaces.cloud, k, kept);
  }
  return kept;
}

SweepOverlap::SweepOverlap(const Seen& before, const Seen& sweep) : T_odom_before_(before.state.T_odom_lidar) {
  for_each_index(2, [&](std::size_t i) {
    if (i == 0) {
      seen_before_ = surfaces_of(before, kSigmaM);
    } else {
      seen_ = surfaces_of(sweep, kPlaceM);
    }
  });
}

void SweepOverlap::look_along(const Vector6d& motion) {
  before_ = telling(seen_before_, motion);
  places_ = telling(seen_, motion);
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

std::vector<double> overlaps_along(std::size_t count, const std::function<double(std::size_t)>& overlap_at,
                                   const std::function<bool()>& late) {
  std::vector<double> overlaps(count, 0.0);
  const auto look_at = [&](const std::vector<std::size_t>& places) {
    const std::vector<double> of_places = overlaps_of(
        places.size(), [&](std::size_t i) { return overlap_at(places[i]); }, late);
    for (std::size_t i = 0; i < places.size(); ++i) {
      overlaps[places[i]] = of_places[i];
    }
  };
  std::vector<std::size_t> seconds;
  for (std::size_t place = 0; place < count; place += 2) {
    seconds.push_back(place);
  }
  look_at(seconds);
  std::stable_sort(seconds.begin(), seconds.end(),
                   [&](std::size_t a, std::size_t b) { return overlaps[a] > overlaps[b]; });
  seconds.resize(std::min(seconds.size(), kLookedBeside));
  std::set<std::size_t> beside;  // two of the best may share one
  for (const std::size_t place : seconds) {
    if (place > 0) {
      beside.insert(place - 1);
    }
    if (place + 1 < count) {
      beside.insert(place + 1);
    }
  }
  look_at({beside.begin(), beside.end()});
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

bool clearly_more(std::span<const double> most, std::span<const double> others, double times) {
  double more = 0.0;
  double less = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < most.size(); ++i) {
    const double difference = most[i] - others[i];
    (difference > 0.0 ? more : less) += std::abs(difference);
    squares += difference * difference;
  }
  return more - less > kSigmas * std::sqrt(squares) && more > times * less;
}

}  // namespace rilo
