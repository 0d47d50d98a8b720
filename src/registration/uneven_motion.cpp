#include "rilo/registration/uneven_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "cloud/fixed_chunks.hpp"
#include "rilo/cloud/deskew.hpp"

namespace rilo {

namespace {

constexpr std::size_t kStretches = 8;
// A stretch sees a sector of the surroundings: what it does not see stays where the registration has it. So far may a
// hand or a road throw the sensor off within a sweep.
constexpr double kLargestShiftM = 0.03;
constexpr double kLargestTurnRad = 0.01;

using Stretches = std::array<NormalEquations, kStretches>;

}  // namespace

Vector6d uneven_motion(const TimedCloud& source, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
                       const AdaptiveIcpConfig& config, double noise_share, std::size_t stride) {
  if (!source.timed() || source.points.empty()) {
    return Vector6d::Zero();
  }
  const auto [earliest, latest] = std::minmax_element(source.offsets_s.begin(), source.offsets_s.end());
  const float first_s = *earliest;
  const float span_s = *latest - first_s;
  if (!(span_s > 0.0F)) {
    return Vector6d::Zero();
  }
  std::vector<Eigen::Vector3f> points;
  deskew(source, icp.state.twist, points);
  const Eigen::Matrix3d R = icp.state.T_odom_lidar.linear();
  const Eigen::Vector3d t = icp.state.T_odom_lidar.translation();
  const double sigma2 = sigma_th_m * sigma_th_m;
  const double gate = config.gate * sigma_th_m;
  const std::size_t count = (points.size() + stride - 1) / stride;
  std::vector<Stretches> partial(chunk_count(count));
  for_fixed_chunks(count, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const auto point_at = [&](std::size_t k) -> Eigen::Vector3d { return R * points[k * stride].cast<double>() + t; };
    map.visit(begin, end, point_at, [&](std::size_t k, const Eigen::Vector3d& world, const PlaneSpot& spot) {
      const MapPlane plane = spot.grid->plane_at(spot);
      const double e = plane.normal.dot(world - plane.point);
      if (std::abs(e) > gate) {
        return;
      }
      Vector6d J;  // of the sensor's own axes
      const Eigen::Vector3d normal = R.transpose() * plane.normal;
      J << (R.transpose() * (world - t)).cross(normal), normal;
      const float place = (source.offsets_s[k * stride] - first_s) / span_s;
      const auto stretch = static_cast<std::size_t>(place * static_cast<float>(kStretches));
      partial[chunk][std::min(stretch, kStretches - 1)].add(J, e, sigma2 / (sigma2 + e * e));
    });
  });
  Stretches sums;
  NormalEquations whole;
  for (const Stretches& part : partial) {
    for (std::size_t s = 0; s < kStretches; ++s) {
      sums[s] += part[s];
      whole += part[s];
    }
  }
  if (!(whole.weight > 0.0)) {
    return Vector6d::Zero();
  }
  const double variance = std::max(whole.squared_error / whole.weight, config.noise_m * config.noise_m);
  const double scale = static_cast<double>(stride) * noise_share / variance;
  Vector6d largest;
  largest << Eigen::Vector3d::Constant(kLargestTurnRad), Eigen::Vector3d::Constant(kLargestShiftM);
  const Matrix6d prior = largest.cwiseAbs2().cwiseInverse().asDiagonal();
  Vector6d squares = Vector6d::Zero();
  Vector6d seen = Vector6d::Zero();
  for (const NormalEquations& sum : sums) {
    const Matrix6d information = scale * sum.pose_hessian();
    const Eigen::LDLT<Matrix6d> solver((information + prior).eval());
    const Vector6d step = solver.solve(-scale * sum.b0);
    const Matrix6d gain = solver.solve(information);
    // The step of noise alone has covariance (Λ + P)⁻¹ Λ (Λ + P)⁻¹.
    const Vector6d noise = (gain * solver.solve(Matrix6d::Identity())).diagonal();
    squares += step.cwiseAbs2() - noise;
    seen += gain.diagonal().cwiseAbs2();
  }
  Vector6d result = squares.cwiseQuotient(seen.cwiseMax(1.0)).cwiseMax(0.0);
  return result.allFinite() ? result : Vector6d(Vector6d::Zero());
}

}  // namespace rilo
