#include "calibration/elevation_information.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "cloud/elevation.hpp"
#include "geometry/degrees.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {

/// Derivatives of a residual. Without a plane the weight is zero.
struct Row {
  Vector6d pose = Vector6d::Zero();
  double lever_s = 0;    // with respect to the velocity: so many times that to the pose
  double elevation = 0;  // to δ
  double own = 0;        // to the elevation angle of the point alone
  double error = 0;
  double weight = 0;
  std::size_t band = 0;

  Vector12d state() const {
    Vector12d both;
    both << pose, lever_s * pose;
    return both;
  }
};

std::size_t band_of(const Eigen::Vector3f& point) {
  const double elevation = std::atan2(point.z(), std::hypot(point.x(), point.y()));
  const double band = std::floor(kDegPerRad * elevation / kBandDeg) + static_cast<double>(kBands) / 2.0;
  return static_cast<std::size_t>(std::clamp(band, 0.0, static_cast<double>(kBands - 1)));
}

std::vector<Row> rows_of(const RegisteredSource& sweep, const LocalMap& map, const PoseDerivative& last, bool refine) {
  const Eigen::Matrix3d R = sweep.state.T_odom_lidar.linear();
  const Eigen::Vector3d t = sweep.state.T_odom_lidar.translation();
  std::vector<Row> rows(sweep.used());
  for_each_residual(sweep, map, [&](std::size_t, const PlaneResidual& residual) {
    const auto& [i, sensor, world, spot, plane, e, w] = residual;
    const Eigen::Vector3d own = R * elevation_jacobian(sensor).cast<double>();
    // Relative to a sensor that continues to move with δ as the last pose did. The plane moves and turns as a whole.
    const Eigen::Vector3d moves = own - spot.grid->elevation_jacobian_at(spot, world, last);
    Row& row = rows[i / sweep.stride];
    row.pose << (world - t).cross(plane.normal), plane.normal;
    row.lever_s = refine ? sweep.state.velocity_lever_s(static_cast<double>(sweep.source.offsets_s[i])) : 0.0;
    row.elevation = plane.normal.dot(moves);
    row.own = plane.normal.dot(own);
    row.error = e;
    row.weight = w;
    row.band = band_of(sensor);
  });
  return rows;
}

}  // namespace

ElevationInformation elevation_information(const TimedCloud& source, const LocalMap& map, const IcpResult& icp,
                                           double sigma_th_m, const AdaptiveIcpConfig& config,
                                           const PoseDerivative& last, std::size_t stride) {
  const Eigen::Vector3d t = icp.state.T_odom_lidar.translation();
  const RegisteredSource sweep{source, icp.state, sigma_th_m, config, stride};
  const std::vector<Row> rows = rows_of(sweep, map, last, source.timed() && config.refine_motion);
  Vector12d mixed = Vector12d::Zero();  // of δ with pose and velocity
  double square = 0.0;
  double gradient = 0.0;
  double weight = 0.0;
  for (const Row& row : rows) {
    mixed += (row.weight * row.elevation) * row.state();
    square += row.weight * row.elevation * row.elevation;
    gradient -= row.weight * row.elevation * row.error;
    weight += row.weight;
  }
  ElevationInformation result;
  result.pose = {t, last.rotation, last.at(t)};
  if (!(weight > 0.0)) {
    return result;
  }
  // As in the posterior: with a scale of its own the pose could explain more than there is.
  const double scale = static_cast<double>(stride) * icp.unit_information;
  // At the registered pose the gradient of pose and velocity is zero: the complement changes the information alone.
  const Vector12d solved = icp.posterior_information.ldlt().solve(scale * mixed);
  const double information = scale * square - scale * mixed.dot(solved);
  if (!std::isfinite(information) || information <= 0.0) {
    return result;
  }
  result.information = information;
  result.gradient = scale * gradient;
  result.jacobian_m = std::sqrt(information / (scale * weight));
  result.pose = {t, last.rotation - solved.head<3>(), last.at(t) - solved.segment<3>(3)};
  for (const Row& row : rows) {
    result.by_band[row.band] += scale * row.weight * row.own * (row.elevation - row.state().dot(solved));
  }
  return result;
}

}  // namespace rilo
