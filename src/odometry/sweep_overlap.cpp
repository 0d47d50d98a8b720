#include "odometry/sweep_overlap.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include "cloud/deskew.hpp"
#include "cloud/point_grid.hpp"
#include "cloud/thinning.hpp"
#include "cloud/voxel_sampler.hpp"

namespace rilo {

namespace {
constexpr double kPlaceM = 1.0;            // edge of a place
constexpr std::size_t kMostPlaces = 1000;  // enough to tell shares a tenth apart
constexpr double kTellsApart = 0.3;        // least cosine between a normal and the direction of a motion that it shows
constexpr double kReachSigmas = 3.0;

/// One point a voxel, of surfaces that show a motion along `direction` or of none.
TimedCloud telling(const SweepOverlap::Seen& seen, const Eigen::Vector3d& direction, double voxel_m) {
  std::vector<Eigen::Vector3f> points;
  deskew(seen.cloud, seen.state.motion(), points);
  VoxelSampler sampler;
  const std::vector<std::uint32_t>& sampled = sampler.sample(points, voxel_m);
  const auto point_at = [&](std::size_t k) -> Eigen::Vector3d {
    return seen.state.T_odom_lidar * points[sampled[k]].cast<double>();
  };
  TimedCloud kept;
  const auto keep = [&](std::size_t k, const Eigen::Vector3d&, const PlaneSpot& spot) {
    if (!spot.scatter && std::abs(spot.grid->plane_at(spot).normal.dot(direction)) < kTellsApart) {
      return;
    }
    kept.points.push_back(seen.cloud.points[sampled[k]]);
    if (seen.cloud.timed()) {
      kept.offsets_s.push_back(seen.cloud.offsets_s[sampled[k]]);
    }
  };
  seen.planes.visit<LocalMap::Wanted::kPlanesAndScatter>(0, sampled.size(), point_at, keep);
  return kept;
}
}  // namespace

SweepOverlap::SweepOverlap(const Seen& before, const Seen& sweep, const Eigen::Vector3d& direction)
    : T_odom_before_(before.state.T_odom_lidar),
      before_(telling(before, direction, kSigmaM)),
      places_(telling(sweep, direction, kPlaceM)) {
  if (places_.size() > kMostPlaces) {
    places_ = thinned(places_, static_cast<double>(kMostPlaces) / static_cast<double>(places_.size()));
  }
}

std::vector<double> SweepOverlap::matches(const MotionState& state, const Vector6d& twist_before) const {
  std::vector<Eigen::Vector3f> points;
  deskew(before_, {.twist = twist_before}, points);
  PointGrid grid(kReachSigmas * kSigmaM);
  grid.build(points);
  deskew(places_, state.motion(), points);
  const Eigen::Isometry3f T_before_lidar = (T_odom_before_.inverse() * state.T_odom_lidar).cast<float>();
  constexpr double kScale = -0.5 / (kSigmaM * kSigmaM);
  std::vector<double> matches(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Neighbour nearest;
    if (grid.nearest(T_before_lidar * points[i], kReachSigmas * kSigmaM, nearest)) {
      matches[i] = std::exp(kScale * static_cast<double>(nearest.distance2));
    }
  }
  return matches;
}

double SweepOverlap::at(const MotionState& state, const Vector6d& twist_before) const {
  const std::vector<double> all = matches(state, twist_before);
  return all.empty() ? 0.0 : std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

}  // namespace rilo
