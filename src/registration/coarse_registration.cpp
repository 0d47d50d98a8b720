#include "registration/coarse_registration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "cloud/fixed_chunks.hpp"
#include "registration/covariances.hpp"
#include "registration/density_filter.hpp"
#include "registration/normal_equations.hpp"

namespace rilo {

namespace {
// Converged below these: the fine registration does the rest.
constexpr double kRotationEpsilonRad = 5e-4;
constexpr double kTranslationEpsilonM = 5e-3;
// Sparse clouds: most of a search among smaller cells would be looking into empty ones.
constexpr double kCellVoxels = 4.0;
constexpr double kNeighbourRadii = 4.0;  // density radii within which the neighbours of a covariance lie
}  // namespace

DistributionCloud make_distribution_cloud(const std::vector<Eigen::Vector3f>& points,
                                          const CoarseRegistrationConfig& config) {
  PointGrid all(config.density_radius_m);
  all.build(points);
  DistributionCloud cloud(kCellVoxels * config.voxel_m);
  cloud.grid.build(density_filter(all, config.density_radius_m, config.density_percentile));
  cloud.covariances = point_covariances(cloud.grid, config.neighbours, kNeighbourRadii * config.density_radius_m);
  return cloud;
}

CoarseSums linearise(const DistributionCloud& source, const DistributionCloud& target, const SE3& T_target_source,
                     double noise_m, const CoarseRegistrationConfig& config, std::vector<std::uint32_t>& matches) {
  const auto& points = source.grid.points();
  matches.resize(points.size(), kNoPoint);
  const Eigen::Matrix3d R = T_target_source.linear();
  const Eigen::Matrix3d noise = noise_m * noise_m * Eigen::Matrix3d::Identity();
  std::vector<CoarseSums> partial(chunk_count<kSmallChunkSize>(points.size()));
  for_fixed_chunks<kSmallChunkSize>(points.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    CoarseSums& sum = partial[chunk];
    for (std::size_t m = first; m < last; ++m) {
      const Eigen::Vector3d p = T_target_source * points[m].cast<double>();
      Neighbour n;
      const bool found = target.grid.nearest(p.cast<float>(), config.max_correspondence_m, n, matches[m]);
      matches[m] = n.index;
      if (!found) {
        continue;
      }
      const Eigen::Vector3d e = target.grid.points()[n.index].cast<double>() - p;  // e_m = q_n − p'_m
      // M_m = C_m + C_n, the source's covariance rotated into the target's frame (eq. 5), and the noise floor.
      const Eigen::Matrix3d M =
          R * source.covariances[m].cast<double>() * R.transpose() + target.covariances[n.index].cast<double>() + noise;
      const Eigen::Matrix3d Mi = M.inverse();
      const double w = std::exp(-e.dot(Mi * e) / (2.0 * config.sigma * config.sigma));  // (eq. 6)
      Eigen::Matrix<double, 3, 6> J;                                                    // of p'_m = exp(δ) T p
      J << -hat(p), Eigen::Matrix3d::Identity();
      const Eigen::Matrix<double, 6, 3> JtW = w * J.transpose() * Mi;
      sum.H += JtW * J;  // (eq. 7)
      sum.b += JtW * e;  // (eq. 8)
      sum.weight += w;
      ++sum.pairs;
    }
  });
  CoarseSums total;
  for (const CoarseSums& sum : partial) {
    total.H += sum.H;
    total.b += sum.b;
    total.weight += sum.weight;
    total.pairs += sum.pairs;
  }
  return total;
}

CoarseResult coarse_registration(const DistributionCloud& source, const DistributionCloud& target, const SE3& initial,
                                 const CoarseRegistrationConfig& config, const Deadline& deadline) {
  CoarseResult result;
  result.T_target_source = initial;
  std::vector<std::uint32_t> matches;
  for (result.iterations = 1; result.iterations <= config.max_iterations; ++result.iterations) {
    // With the covariances of surfaces alone, the weights of far pairs vanish at once. Annealing: a noise that shrinks
    // from iteration to iteration lets far pairs contribute in the first iterations only.
    const double share = std::min(1.0, 2.0 * (result.iterations - 1) / std::max(1.0, config.max_iterations - 1.0));
    const double noise = config.noise_first_m * std::pow(config.noise_last_m / config.noise_first_m, share);
    const CoarseSums sums = linearise(source, target, result.T_target_source, noise, config, matches);
    result.pairs = sums.pairs;
    result.mean_weight = source.size() > 0 ? sums.weight / static_cast<double>(source.size()) : 0.0;
    if (sums.pairs < kLeastCorrespondences) {
      break;
    }
    const double lambda = config.damping * sums.H.diagonal().maxCoeff();
    const Vector6d delta = (sums.H + lambda * Matrix6d::Identity()).ldlt().solve(sums.b);  // (eq. 9)
    if (!delta.allFinite()) {
      break;
    }
    result.T_target_source = se3_exp(delta) * result.T_target_source;
    if (share >= 1.0 && delta.head<3>().norm() < kRotationEpsilonRad && delta.tail<3>().norm() < kTranslationEpsilonM) {
      result.converged = true;
      break;
    }
    result.cut = result.iterations < config.max_iterations && deadline.passed();
    if (result.cut) {
      break;
    }
  }
  result.iterations = std::min(result.iterations, config.max_iterations);
  return result;
}

}  // namespace rilo
