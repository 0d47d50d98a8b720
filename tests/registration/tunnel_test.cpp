// A tunnel without features, seen by a sensor with few beams: what its map shows along the axis are errors of normals.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {
namespace {

constexpr double kSweepStep = 0.35;    // m, from sweep to sweep
constexpr double kRangeNoise = 0.018;  // m, of a range
const double kDegenerateRatio = OdometryConfig{}.health.degenerate_ratio;

/// Distance along the unit ray `d` from `p` to the surface of a tunnel, 4 m wide and 3 m high, with a ledge along one
/// wall, a pipe along the other and a wall across it at `end_m`.
double range_m(const Eigen::Vector3d& p, const Eigen::Vector3d& d, double end_m) {
  constexpr double kHalfWidth = 2.0;
  constexpr double kFloor = -0.9;
  constexpr double kCeiling = 2.1;
  const double side = d.y() > 0.0 ? (kHalfWidth - p.y()) / d.y() : (-kHalfWidth - p.y()) / d.y();
  const double level = d.z() > 0.0 ? (kCeiling - p.z()) / d.z() : (kFloor - p.z()) / d.z();
  double r = std::min(side, level);
  const double ledge = (-kHalfWidth + 0.15 - p.y()) / d.y();
  const double ledge_z = p.z() + ledge * d.z();
  if (d.y() < 0.0 && ledge > 0.0 && ledge_z > kFloor && ledge_z < kFloor + 0.1) {
    r = std::min(r, ledge);
  }
  const double pipe = (kHalfWidth - 0.12 - p.y()) / d.y();
  const double pipe_z = p.z() + pipe * d.z();
  if (d.y() > 0.0 && pipe > 0.0 && pipe_z > 0.6 && pipe_z < 0.72) {
    r = std::min(r, pipe);
  }
  return d.x() > 0.0 ? std::min(r, (end_m - p.x()) / d.x()) : r;
}

/// A sweep of 16 beams 2° apart in a sensor at `x_m`, which looks along the tunnel.
std::vector<Eigen::Vector3f> sweep_at(double x_m, double end_m, std::mt19937& rng) {
  std::normal_distribution<double> noise(0.0, kRangeNoise);
  std::vector<Eigen::Vector3f> points;
  for (int azimuth = 0; azimuth < 1800; ++azimuth) {
    for (int beam = 0; beam < 16; ++beam) {
      const double a = (azimuth + 0.5) * std::numbers::pi / 900.0;  // no ray runs exactly along the walls
      const double e = (2.0 * beam - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      const double r = range_m({x_m, 0.3, 0.0}, d, end_m);
      if (r < 60.0) {
        points.push_back(((r + noise(rng)) * d).cast<float>());
      }
    }
  }
  return points;
}

/// A sweep registered to the map of 20 sweeps before it.
IcpResult registered(double end_m) {
  std::mt19937 rng(7);
  LocalMap map{LocalMapConfig{}};
  map.set_scene_range(4.0);
  SE3 T = SE3::Identity();
  for (int sweep = 0; sweep < 20; ++sweep) {
    map.insert(sweep_at(T.translation().x(), end_m, rng), T);
    T.translation().x() += kSweepStep;
  }
  MotionPrior prior;
  prior.state.T_odom_lidar = T;
  prior.information = 100.0 * Matrix12d::Identity();
  return adaptive_icp({sweep_at(T.translation().x(), end_m, rng), {}}, map, prior.state, prior, 0.05, {});
}

TEST(Tunnel, FewBeamsDoNotShowTheWayAlongIt) {
  const IcpResult result = registered(1000.0);
  ASSERT_TRUE(result.converged());
  const Vector6d& observed = result.degeneracy.relative_eigenvalues;
  EXPECT_LT(observed[0], 0.3 * kDegenerateRatio) << "what the scatter of the points explains would leave 0.0032";
  EXPECT_GT(observed[1], 3.0 * kDegenerateRatio);
  const Vector6d unseen = result.degeneracy.directions.col(0);
  EXPECT_GT(std::abs(unseen[3]), 0.95) << unseen.transpose();
}

TEST(Tunnel, AWallAcrossShowsIt) {
  const IcpResult result = registered(12.0);
  ASSERT_TRUE(result.converged());
  EXPECT_GT(result.degeneracy.relative_eigenvalues[0], 2.0 * kDegenerateRatio);
}

}  // namespace
}  // namespace rilo
