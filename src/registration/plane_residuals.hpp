// Residuals of a registered sweep against the planes of the map.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/deskew.hpp"
#include "cloud/fixed_chunks.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"

namespace rilo {

/// Where many points show the same, every so many of them are used: for figures that are averaged over sweeps, ...
inline constexpr std::size_t kSampleStride = 4;
/// ... and for what only has to be about right.
inline constexpr std::size_t kSparseStride = 8;

/// β_k, the weight of a residual (eq. 21).
class ResidualWeight {
 public:
  /// `sigma_th_m`: scale of the weights, not used with `config.adaptive` off.
  ResidualWeight(const AdaptiveIcpConfig& config, double sigma_th_m)
      : adaptive_(config.adaptive),
        sigma2_(sigma_th_m * sigma_th_m),
        gate2_(std::pow(config.adaptive ? config.gate * sigma_th_m : config.fixed_gate_m, 2)) {}

  /// 0 beyond the gate. `share`: of the squared distance that counts, because the surface scatters along it.
  double of(double distance_m, double share = 1.0) const {
    const double e2 = share * distance_m * distance_m;
    return e2 > gate2_ ? 0.0 : share * (adaptive_ ? sigma2_ / (sigma2_ + e2) : 1.0);
  }

 private:
  bool adaptive_;
  double sigma2_;
  double gate2_;
};

/// A point and its surface element.
struct PlaneResidual {
  std::size_t index = 0;   ///< of the point in the sweep
  Eigen::Vector3f sensor;  ///< the point, motion-compensated (m, sensor frame)
  Eigen::Vector3d world;   ///< the same, odometry frame
  PlaneSpot spot;          ///< of the plane in its grid
  MapPlane plane;
  double distance_m = 0;  ///< of the point from the plane, along its normal
  double weight = 0;      ///< β_k and the plane's, as in the registration
};

/// A registered sweep, and which of its points are used.
struct RegisteredSource {
  const TimedCloud& source;
  const MotionState& state;
  double sigma_th_m = 0;  ///< scale of the weights
  const AdaptiveIcpConfig& config;
  std::size_t stride = 1;

  std::size_t used() const { return (source.size() + stride - 1) / stride; }
};

/// Calls use(chunk, residual) for each point with a plane; chunks as those of for_fixed_chunks over used().
template <typename Use>
void for_each_residual(const RegisteredSource& sweep, const LocalMap& map, const Use& use) {
  const Eigen::Matrix3d R = sweep.state.T_odom_lidar.linear();
  const Eigen::Vector3d t = sweep.state.T_odom_lidar.translation();
  const ResidualWeight weight(sweep.config, sweep.sigma_th_m);
  const SweepMotion motion = SweepMotion::during(sweep.source, sweep.state.motion());
  for_fixed_chunks(sweep.used(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const auto point_at = [&](std::size_t k) { return motion.compensated(sweep.source, k * sweep.stride); };
    const auto world_at = [&](std::size_t k) -> Eigen::Vector3d { return R * point_at(k).template cast<double>() + t; };
    map.visit(begin, end, world_at, [&](std::size_t k, const Eigen::Vector3d& world, const PlaneSpot& spot) {
      const MapPlane plane = spot.grid->plane_at(spot);
      const double e = plane.normal.dot(world - plane.point);
      if (const double beta = static_cast<double>(plane.weight) * weight.of(e); beta > 0.0) {
        use(chunk, PlaneResidual{k * sweep.stride, point_at(k), world, spot, plane, e, beta});
      }
    });
  });
}

/// Sum of what add(sum, residual) adds up, the same bits for any number of threads.
template <typename Sum, typename Add>
Sum sum_of_residuals(const RegisteredSource& sweep, const LocalMap& map, const Add& add) {
  std::vector<Sum> partial(chunk_count(sweep.used()));
  for_each_residual(sweep, map,
                    [&](std::size_t chunk, const PlaneResidual& residual) { add(partial[chunk], residual); });
  Sum total;
  for (const Sum& sum : partial) {
    total += sum;
  }
  return total;
}

}  // namespace rilo
