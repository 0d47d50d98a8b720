// Residuals of points against the planes of the map, and their normal equations.
#include <array>
#include <cmath>

#include "cloud/deskew.hpp"
#include "cloud/fixed_chunks.hpp"
#include "registration/adaptive_icp.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {

// A point whose match reads the map is announced so many points ahead.
constexpr std::size_t kPrefetchAhead = 8;

/// Derivative of the distance of a point from a plane with respect to the pose: [(q × n)ᵀ nᵀ], `q` from the sensor to
/// the point.
Vector6d pose_jacobian(const Eigen::Vector3f& q, const Eigen::Vector3f& normal) {
  Vector6d J;
  J << q.cross(normal).cast<double>(), normal.cast<double>();
  return J;
}

/// What a wider plane does not confirm of β J Jᵀ: β (J Jᵀ − ½ (J J_wᵀ + J_w Jᵀ)).
Matrix6d unconfirmed_part(double beta, const Vector6d& J, const Vector6d& J_wider) {
  const Vector6d error = J - J_wider;
  return 0.5 * beta * (J * error.transpose() + error * J.transpose());
}

/// Weights residuals and adds them to normal equations, all at one state.
class Equations {
 public:
  Equations(const TimedCloud& source, const MotionState& state, double sigma_th_m, const AdaptiveIcpConfig& config,
            NormalEquations& sums)
      : refine_(source.timed() && config.refine_motion),
        block_(sums, refine_),
        source_(source),
        state_(state),
        weight_(config, sigma_th_m),
        scatter_noise2_(config.scatter_noise_m * config.scatter_noise_m) {}

  /// Distance of the point `i` of the source, at `q` from the sensor, from a plane; returns its weight β_k.
  double add(std::size_t i, const Eigen::Vector3f& q, const Eigen::Vector3f& normal, double distance_m, double weight) {
    const double beta = weight * weight_.of(distance_m);
    if (beta > 0.0) {
      block_.add(q, normal, distance_m, beta, lever_s(i));
    }
    return beta;
  }

  /// Points that are not a plane: their Gaussian, with the noise of the point, along each of its axes.
  void add(std::size_t i, const Eigen::Vector3f& q, const Eigen::Vector3d& world, const MapScatter& scatter) {
    const Eigen::Vector3d e = scatter.axes.transpose() * (world - scatter.mean);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = scatter.bounded[axis] * scatter_noise2_ / (scatter_noise2_ + scatter.variances[axis]);
      const double beta = scatter.weight * weight_.of(e[axis], share);
      if (beta > 0.0) {
        block_.add(q, scatter.axes.col(axis).cast<float>(), e[axis], beta, lever_s(i));
      }
    }
  }

  void finish() { block_.flush(); }

 private:
  /// 0 leaves the velocity out.
  double lever_s(std::size_t i) const {
    return refine_ ? state_.velocity_lever_s(static_cast<double>(source_.offsets_s[i])) : 0.0;
  }

  bool refine_;
  ResidualBlock block_;
  const TimedCloud& source_;
  const MotionState& state_;
  ResidualWeight weight_;
  double scatter_noise2_;
};

}  // namespace

void PlaneMatches::look_up(const LocalMap& map, std::size_t first, std::span<const Eigen::Vector3d> world,
                           std::size_t stride) {
  std::array<std::size_t, kChunkSize> moved{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < world.size(); ++k) {
    const std::size_t i = (first + k) * stride;
    Match& match = matches_[i];
    const VoxelIndex voxel = map.finest_voxel(world[k]);
    if (match.meets == Meets::kUnknown || (!frozen_ && match.voxel != voxel)) {
      match.meets = Meets::kNothing;
      match.voxel = voxel;
      if (i % kSparseStride == 0) {
        wider_[i / kSparseStride].known = false;
      }
      moved[count++] = k;
    }
  }
  map.visit<LocalMap::Wanted::kPlanesAndScatter>(
      0, count, [&](std::size_t j) { return world[moved[j]]; },
      [&](std::size_t j, const Eigen::Vector3d&, const PlaneSpot& spot) {
        const std::size_t i = (first + moved[j]) * stride;
        Match& match = matches_[i];
        spots_[i] = spot;
        match.meets = spot.scatter ? Meets::kScatter : Meets::kPlane;
        if (!spot.scatter) {
          const MapPlane plane = spot.grid->plane_at(spot);
          match.normal = plane.normal.cast<float>();  // as the map keeps it
          match.distance_m = plane.normal.dot(plane.point);
          match.weight = plane.weight;
        }
      });
}

const Eigen::Vector3f& PlaneMatches::wider_normal(const LocalMap& map, std::size_t i) {
  WiderNormal& wider = wider_[i / kSparseStride];
  if (!wider.known) {
    wider.known = true;
    wider.normal = matches_[i].normal;
    PlaneSpot spot;
    if (map.find_wider(spots_[i], spot)) {
      const Eigen::Vector3f normal = spot.grid->plane_at(spot).normal.cast<float>();
      wider.normal = normal.dot(matches_[i].normal) < 0.0F ? Eigen::Vector3f(-normal) : normal;
    }
  }
  return wider.normal;
}

void PlaneMatches::begin(const TimedCloud& source) {
  span_ = span_of(source);
  matches_.resize(source.size());
  spots_.resize(source.size());
  wider_.resize(source.size() / kSparseStride + 1);
}

NormalEquations PlaneMatches::linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state,
                                        double sigma_th_m, const AdaptiveIcpConfig& config, std::size_t stride) {
  const Eigen::Vector3d t = state.T_odom_lidar.translation();
  if (!span_) {
    begin(source);
  }
  const SweepMotion motion(state.motion(), *span_, state.T_odom_lidar.linear());
  const std::size_t count = (source.size() + stride - 1) / stride;
  std::vector<NormalEquations> partial(chunk_count(count));
  std::vector<Matrix6d> unconfirmed(chunk_count(count), Matrix6d::Zero());
  for_fixed_chunks(count, [&](std::size_t chunk, std::size_t first, std::size_t last) {
    std::array<Eigen::Vector3f, kChunkSize> from_sensor;  // axes of the odometry frame
    std::array<Eigen::Vector3d, kChunkSize> world;
    for (std::size_t k = first; k < last; ++k) {
      from_sensor[k - first] = motion.compensated(source, k * stride);
      world[k - first] = from_sensor[k - first].cast<double>() + t;
    }
    look_up(map, first, {world.data(), last - first}, stride);
    Equations equations(source, state, sigma_th_m, config, partial[chunk]);
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t i = k * stride;
      const Match& match = matches_[i];
      const Eigen::Vector3f& q = from_sensor[k - first];
      const Eigen::Vector3d& p = world[k - first];
      if (k + kPrefetchAhead < last) {
        prefetch(i + kPrefetchAhead * stride);
      }
      if (match.meets == Meets::kScatter) {
        equations.add(i, q, p, spots_[i].grid->scatter_at(spots_[i]));
      } else if (match.meets == Meets::kPlane) {
        const double distance_m = match.normal.cast<double>().dot(p) - match.distance_m;  // (p − q)·n
        const double beta = equations.add(i, q, match.normal, distance_m, static_cast<double>(match.weight));
        if (k % kSparseStride == 0 && beta > 0.0) {
          unconfirmed[chunk] +=
              unconfirmed_part(beta, pose_jacobian(q, match.normal), pose_jacobian(q, wider_normal(map, i)));
        }
      }
    }
    equations.finish();
  });
  unconfirmed_.setZero();
  NormalEquations total;
  for (std::size_t chunk = 0; chunk < partial.size(); ++chunk) {
    total += partial[chunk];
    unconfirmed_ += static_cast<double>(kSparseStride) * unconfirmed[chunk];
  }
  return total;
}

NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                          const AdaptiveIcpConfig& config, std::size_t stride) {
  return PlaneMatches().linearise(source, map, state, sigma_th_m, config, stride);
}

}  // namespace rilo
