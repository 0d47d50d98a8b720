#include "registration/adaptive_icp.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "registration/acceleration.hpp"

namespace rilo {

namespace {

// Below this many points a stride saves nothing and loses accuracy.
constexpr std::size_t kLeastForStride = 4000;
// Of the information on a direction, what is not confirmed counts so many times, so that one counts as not observed
// unless a quarter is: at most 0.1 in tunnels without features, 0.3 to 0.9 elsewhere (experiment: wider planes).
constexpr double kUnconfirmedMargin = 4.0 / 3.0;
// The strided cloud is weighted with this multiple of sigma_th: a sweep off by more than the scale of the weights would
// stay where it is.
constexpr double kWideStart = 3.0;
// From this iteration on, which 95 % of the sweeps of a drive do not need, points keep their correspondences: a few
// that change planes at every step would keep the sweep oscillating.
constexpr int kFreezeAfter = 16;
// Of the largest information: below it sums of single precision show nothing.
constexpr double kRounding = 1e-6;

}  // namespace

Vector12d prior_error(const MotionPrior& prior, const MotionState& state) {
  Vector12d e;
  const SE3& T = state.T_odom_lidar;
  const SE3& T0 = prior.state.T_odom_lidar;
  e.segment<3>(0) = so3_log(T.linear() * T0.linear().transpose());
  e.segment<3>(3) = T.translation() - T0.translation();
  e.tail<6>() = state.twist_in_odom() - prior.state.twist_in_odom();
  return e;
}

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

namespace {

/// One Gauss-Newton step with damping; false if the system is singular.
bool step(const NormalEquations& sums, const Matrix6d& unconfirmed, const MotionPrior& prior,
          const AdaptiveIcpConfig& config, double information_scale, IcpResult& result, Vector12d& delta) {
  const double variance = sums.squared_error / sums.weight;
  result.inliers = sums.count;
  result.residual_rms_m = std::sqrt(variance);
  result.unit_information = config.independent_share / std::max(variance, config.noise_m * config.noise_m);
  const double scale = information_scale * result.unit_information;
  result.lidar_information = scale * sums.pose_hessian();
  result.degeneracy = analyse_degeneracy(result.lidar_information, kUnconfirmedMargin * scale * unconfirmed);
  Matrix12d H = scale * sums.hessian();
  Vector12d b = -scale * sums.gradient();
  const Matrix6d select = soft_selection(result.degeneracy, std::max(config.weak_direction, kRounding));
  Matrix12d W = Matrix12d::Zero();
  W.topLeftCorner<6, 6>() = select;
  W.bottomRightCorner<6, 6>() = select;
  H = (W.transpose() * H * W).eval();
  // W carries the square root of the share: once for each side of H, twice for b. Once alone would make a faded
  // direction overshoot by 1 / sqrt(share).
  b = (W.transpose() * (W.transpose() * b)).eval();
  result.sweep_information = H;
  H += prior.information;
  b -= prior.information * prior_error(prior, result.state);
  result.posterior_information = H;
  H.diagonal().array() += config.damping * H.diagonal().maxCoeff();  // (H + λI) Δx = b
  delta = H.ldlt().solve(b);
  return delta.allFinite();
}

}  // namespace

IcpResult adaptive_icp(const TimedCloud& source, const LocalMap& map, const MotionState& initial,
                       const MotionPrior& prior, double sigma_th_m, const AdaptiveIcpConfig& config,
                       const Deadline& deadline) {
  IcpResult result;
  result.state = initial;
  PlaneMatches matches;
  Acceleration acceleration;
  std::size_t stride = source.size() >= kLeastForStride ? static_cast<std::size_t>(config.coarse_stride) : 1;
  while (result.iterations < config.max_iterations) {
    ++result.iterations;
    const double sigma_m = stride > 1 ? kWideStart * sigma_th_m : sigma_th_m;
    const NormalEquations sums = matches.linearise(source, map, result.state, sigma_m, config, stride);
    Vector12d delta;
    if (sums.count < kLeastCorrespondences ||
        !step(sums, matches.unconfirmed(), prior, config, static_cast<double>(stride), result, delta)) {
      result.inliers = sums.count;
      result.termination = IcpTermination::kSingular;
      break;
    }
    result.state = perturbed(result.state, acceleration.moved(delta, result.posterior_information));
    result.last_update = delta.head<6>();
    // In standard deviations of the state, so that it means the same for all sensors and places. The strided cloud need
    // not converge as far as the whole one: what is left is below the noise of its sample.
    const double epsilon = static_cast<double>(stride) * config.epsilon;
    const bool small = delta.dot(result.posterior_information * delta) < epsilon * epsilon;
    if (small && stride == 1) {
      result.termination = IcpTermination::kConverged;
      break;
    }
    const bool late = deadline.passed();
    if (late && stride == 1) {
      result.termination = IcpTermination::kTimeLimit;
      break;
    }
    if (result.iterations == kFreezeAfter) {
      matches.freeze();
      result.frozen = true;
    }
    if (small || late || result.iterations == config.max_iterations / 2) {
      stride = 1;
      acceleration.restart();
    }
  }
  return result;
}

}  // namespace rilo
