#include "registration/uneven_motion.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Cholesky>

#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {

constexpr std::size_t kStretches = 8;  // short against a tremor of the hand, long enough to be registered
// A stretch sees a sector of the surroundings: unobserved directions stay at the registered pose. Upper bound of the
// deviation within a sweep, by a hand or a road.
constexpr double kLargestShiftM = 0.03;
constexpr double kLargestTurnRad = 0.01;

/// Normal equations of each stretch.
struct Stretches : std::array<NormalEquations, kStretches> {
  void operator+=(const Stretches& other) {
    for (std::size_t s = 0; s < kStretches; ++s) {
      (*this)[s] += other[s];
    }
  }
};

/// Mean square of what the stretches moved on their own beyond what noise explains; `scale`: of their information.
Vector6d scatter(const Stretches& stretches, double scale) {
  Vector6d largest;
  largest << Eigen::Vector3d::Constant(kLargestTurnRad), Eigen::Vector3d::Constant(kLargestShiftM);
  const Matrix6d prior = largest.cwiseAbs2().cwiseInverse().asDiagonal();
  Vector6d squares = Vector6d::Zero();
  Vector6d seen = Vector6d::Zero();
  for (const NormalEquations& sum : stretches) {
    const Matrix6d information = scale * sum.pose_hessian();
    const Eigen::LDLT<Matrix6d> solver((information + prior).eval());
    const Vector6d step = solver.solve(-scale * sum.b0);
    const Matrix6d gain = solver.solve(information);
    // The step of noise alone has covariance (Λ + P)⁻¹ Λ (Λ + P)⁻¹.
    const Vector6d noise = (gain * solver.solve(Matrix6d::Identity())).diagonal();
    squares += step.cwiseAbs2() - noise;
    seen += gain.diagonal().cwiseAbs2();
  }
  return squares.cwiseQuotient(seen.cwiseMax(1.0)).cwiseMax(0.0);
}

}  // namespace

Vector6d uneven_motion(const TimedCloud& source, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
                       const AdaptiveIcpConfig& config, double noise_share, std::size_t stride) {
  const TimeSpan span = span_of(source);
  if (!(span.length_s() > 0.0F)) {
    return Vector6d::Zero();
  }
  const Eigen::Matrix3d to_sensor = icp.state.T_odom_lidar.linear().transpose();
  const Eigen::Vector3d t = icp.state.T_odom_lidar.translation();
  const RegisteredSource sweep{source, icp.state, sigma_th_m, config, stride};
  const auto stretches = sum_of_residuals<Stretches>(sweep, map, [&](Stretches& sums, const PlaneResidual& residual) {
    Vector6d J;  // of the sensor's own axes
    const Eigen::Vector3d normal = to_sensor * residual.plane.normal;
    J << (to_sensor * (residual.world - t)).cross(normal), normal;
    const float place = (source.offsets_s[residual.index] - span.begin_s) / span.length_s();
    const auto stretch = static_cast<std::size_t>(place * static_cast<float>(kStretches));
    sums[std::min(stretch, kStretches - 1)].add(J, residual.distance_m, residual.weight);
  });
  NormalEquations whole;
  for (const NormalEquations& sum : stretches) {
    whole += sum;
  }
  if (!(whole.weight > 0.0)) {
    return Vector6d::Zero();
  }
  const double variance = std::max(whole.squared_error / whole.weight, config.noise_m * config.noise_m);
  const Vector6d result = scatter(stretches, static_cast<double>(stride) * noise_share / variance);
  return result.allFinite() ? result : Vector6d(Vector6d::Zero());
}

}  // namespace rilo
