// A tunnel without features, seen by a sensor with few beams: what its map shows along the axis are errors of normals.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/plane_residuals.hpp"
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

/// The map of four sweeps from nearly the same place, and another sweep.
struct ShortMap {
  LocalMap map{LocalMapConfig{}};
  TimedCloud source;

  ShortMap() {
    std::mt19937 rng(7);
    map.set_scene_range(4.0);
    for (int sweep = 0; sweep < 4; ++sweep) {
      map.insert(sweep_at(0.1 * sweep, 12.0, rng), SE3(Eigen::Translation3d(0.1 * sweep, 0.0, 0.0)));
    }
    source.points = sweep_at(0.0, 12.0, rng);
  }
};

TEST(Tunnel, OfWhatIsNotConfirmedFourThirdsAreTakenOff) {
  const ShortMap scene;
  AdaptiveIcpConfig config;
  config.max_iterations = 1;
  config.coarse_stride = 1;
  const IcpResult icp = adaptive_icp(scene.source, scene.map, {}, {}, 0.05, config);
  PlaneMatches matches;
  const NormalEquations sums = matches.linearise(scene.source, scene.map, {}, 0.05, config, 1);
  ASSERT_GT(matches.unconfirmed().norm(), 0.0);
  const PoseDegeneracy expected = analyse_degeneracy(sums.pose_hessian(), 4.0 / 3.0 * matches.unconfirmed());
  EXPECT_TRUE(icp.degeneracy.relative_eigenvalues.isApprox(expected.relative_eigenvalues, 1e-9));
}

TEST(Tunnel, APointThatLeavesItsVoxelHasAnotherWiderPlane) {
  const ShortMap scene;
  MotionState moved;
  moved.T_odom_lidar.translation().x() = 1.01 * LocalMapConfig{}.voxel_m;
  PlaneMatches kept;
  kept.linearise(scene.source, scene.map, {}, 0.05, {}, 1);
  const Matrix6d before = kept.unconfirmed();
  kept.linearise(scene.source, scene.map, moved, 0.05, {}, 1);
  PlaneMatches fresh;
  fresh.linearise(scene.source, scene.map, moved, 0.05, {}, 1);
  EXPECT_FALSE(before.isApprox(fresh.unconfirmed(), 1e-3));
  EXPECT_TRUE(kept.unconfirmed().isApprox(fresh.unconfirmed(), 1e-9));
}

TEST(Tunnel, APlaneOfAnUnreliableNormalWeighsLess) {
  const ShortMap scene;
  constexpr double kScaleM = 0.05;
  int checked = 0;
  for (const Eigen::Vector3f& p : scene.source.points) {
    MapPlane plane;
    if (checked == 20 || !scene.map.find(p.cast<double>(), plane) || plane.weight < 0.2F || plane.weight > 0.8F) {
      continue;
    }
    const double e = plane.normal.dot(p.cast<double>() - plane.point);
    if (std::abs(e) > 0.1 || std::abs(e) < 0.001) {
      continue;
    }
    ++checked;
    const double weight = static_cast<double>(plane.weight) * kScaleM * kScaleM / (kScaleM * kScaleM + e * e);
    const TimedCloud one{{p}, {}};
    EXPECT_NEAR(linearise(one, scene.map, {}, kScaleM, {}).weight, weight, 1e-5);
    const auto weight_within = [&](double gate_m, bool adaptive) {
      AdaptiveIcpConfig config;
      config.adaptive = adaptive;
      (adaptive ? config.gate : config.fixed_gate_m) = adaptive ? gate_m / kScaleM : gate_m;
      double found = 0.0;
      for_each_residual({one, {}, kScaleM, config}, scene.map,
                        [&](std::size_t, const PlaneResidual& residual) { found = residual.weight; });
      return found;
    };
    EXPECT_NEAR(weight_within(1.01 * std::abs(e), true), weight, 1e-5);
    EXPECT_EQ(weight_within(0.99 * std::abs(e), true), 0.0) << "beyond the gate";
    EXPECT_NEAR(weight_within(1.01 * std::abs(e), false), static_cast<double>(plane.weight), 1e-5);
    EXPECT_EQ(weight_within(0.99 * std::abs(e), false), 0.0) << "beyond the gate";
  }
  EXPECT_EQ(checked, 20);
}

}  // namespace
}  // namespace rilo
