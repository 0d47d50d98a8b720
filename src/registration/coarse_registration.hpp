// Distribution-to-distribution coarse registration (III-A, Algorithm 1).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud/point_grid.hpp"
#include "registration/deadline.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// A density-filtered cloud with its search grid and covariances: source of one sweep, target of the next.
struct DistributionCloud {
  PointGrid grid;
  std::vector<Eigen::Matrix3f> covariances;

  explicit DistributionCloud(double cell_m) : grid(cell_m) {}
  std::size_t size() const { return covariances.size(); }
};

/// Density filter and covariances of `points` (sensor frame).
DistributionCloud make_distribution_cloud(const std::vector<Eigen::Vector3f>& points,
                                          const CoarseRegistrationConfig& config);

struct CoarseResult {
  SE3 T_target_source = SE3::Identity();  ///< T_align
  bool converged = false;
  bool cut = false;  ///< ended by the deadline
  int iterations = 0;
  std::size_t pairs = 0;
  double mean_weight = 0;  ///< mean w_m over the source: 1 is a perfect fit
};

/// Sums over the pairs. The error is q − T p and its perturbation is a left one, exp(δ) T, in the target's frame, which
/// is the sensor frame of the sweep before: lever arms stay short.
struct CoarseSums {
  Matrix6d H = Matrix6d::Zero();  ///< eq. 7
  Vector6d b = Vector6d::Zero();  ///< eq. 8
  double weight = 0;              ///< Σ w_m
  std::size_t pairs = 0;
};

/// The sums at `T_target_source`, with the noise `noise_m` (standard deviation) added to the covariances. `matches`:
/// partner of each source point, kNoPoint where there is none; read as a guess, then written.
CoarseSums linearise(const DistributionCloud& source, const DistributionCloud& target, const SE3& T_target_source,
                     double noise_m, const CoarseRegistrationConfig& config, std::vector<std::uint32_t>& matches);

/// Algorithm 1 from `initial`. After the deadline no further iteration begins.
CoarseResult coarse_registration(const DistributionCloud& source, const DistributionCloud& target, const SE3& initial,
                                 const CoarseRegistrationConfig& config, const Deadline& deadline = {});

}  // namespace rilo
