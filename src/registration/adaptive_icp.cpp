#include "rilo/registration/adaptive_icp.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "cloud/fixed_chunks.hpp"
#include "rilo/cloud/deskew.hpp"

namespace rilo {

namespace {

Vector12d prior_error(const MotionPrior& prior, const MotionState& state) {
  Vector12d e;
  const SE3& T = state.T_odom_lidar;
  const SE3& T0 = prior.state.T_odom_lidar;
  e.segment<3>(0) = so3_log(T.linear() * T0.linear().transpose());
  e.segment<3>(3) = T.translation() - T0.translation();
  e.segment<3>(6) = T.linear() * state.twist.head<3>() - T0.linear() * prior.state.twist.head<3>();
  e.segment<3>(9) = T.linear() * state.twist.tail<3>() - T0.linear() * prior.state.twist.tail<3>();
  return e;
}

}  // namespace

MotionState perturbed(const MotionState& state, const Vector12d& delta) {
  MotionState moved = state;
  SE3& T = moved.T_odom_lidar;
  const Eigen::Matrix3d R_old = T.linear();
  T.linear() = so3_exp(delta.segment<3>(0)) * R_old;
  T.translation() += delta.segment<3>(3);
  moved.twist.head<3>() += R_old.transpose() * delta.segment<3>(6);
  moved.twist.tail<3>() += R_old.transpose() * delta.segment<3>(9);
  return moved;
}

NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                          const AdaptiveIcpConfig& config) {
  const bool timed = source.timed();
  const Eigen::Matrix3d R = state.T_odom_lidar.linear();
  const Eigen::Vector3d t = state.T_odom_lidar.translation();
  float begin = 0;
  float end = 0;
  if (timed && !source.points.empty()) {
    const auto [lo, hi] = std::minmax_element(source.offsets_s.begin(), source.offsets_s.end());
    begin = *lo;
    end = *hi;
  }
  const SweepMotion motion(state.twist, begin, end);
  const double gate = config.gate * sigma_th_m;
  const double sigma2 = sigma_th_m * sigma_th_m;
  std::vector<NormalEquations> partial(chunk_count(source.size()));
  for_fixed_chunks(source.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    NormalEquations sum;
    MapPlane plane;
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Vector3f p = timed ? motion.compensate(source.points[i], source.offsets_s[i]) : source.points[i];
      const Eigen::Vector3d lever = R * p.cast<double>();
      const Eigen::Vector3d world = lever + t;
      if (!map.find(world, plane)) {
        continue;
      }
      const double e = plane.normal.dot(world - plane.point);  // e_k = (p_k − q_k)·n_k
      if (std::abs(e) > gate) {
        continue;
      }
      const double beta = config.adaptive ? sigma2 / (sigma2 + e * e) : 1.0;
      Vector6d J;
      J << lever.cross(plane.normal), plane.normal;
      if (timed && config.refine_motion) {
        sum.add(J, e, beta, static_cast<double>(source.offsets_s[i]));
      } else {
        sum.add(J, e, beta);
      }
    }
    partial[chunk] = sum;
  });
  NormalEquations total;
  for (const NormalEquations& sum : partial) {
    total += sum;
  }
  return total;
}

IcpResult adaptive_icp(const TimedCloud& source, const LocalMap& map, const MotionState& initial, const MotionPrior& prior,
                       double sigma_th_m, const AdaptiveIcpConfig& config) {
  IcpResult result;
  result.state = initial;
  for (result.iterations = 1; result.iterations <= config.max_iterations; ++result.iterations) {
    const NormalEquations sums = linearise(source, map, result.state, sigma_th_m, config);
    result.inliers = sums.count;
    if (sums.count < 10) {
      break;
    }
    const double variance = std::max(sums.squared_error / sums.weight, config.noise_m * config.noise_m);
    result.residual_rms_m = std::sqrt(sums.squared_error / sums.weight);
    const double scale = config.information_scale / variance;
    result.lidar_information = scale * sums.pose_hessian();
    Matrix12d H = scale * sums.hessian();
    Vector12d b = -scale * sums.gradient();
    if (config.motion_prior) {
      H += prior.information;
      b -= prior.information * prior_error(prior, result.state);
    }
    result.posterior_information = H;
    H.diagonal().array() += config.damping * H.diagonal().maxCoeff() * 1e-3;  // (H + λI)
    const Vector12d delta = H.ldlt().solve(b);
    if (!delta.allFinite()) {
      break;
    }
    result.state = perturbed(result.state, delta);
    if (delta.head<3>().norm() < config.rotation_epsilon_rad && delta.segment<3>(3).norm() < config.translation_epsilon_m) {
      result.converged = true;
      break;
    }
  }
  result.iterations = std::min(result.iterations, config.max_iterations);
  return result;
}

}  // namespace rilo
