// Which residuals count and how much: the gate, and points that are no plane.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

constexpr double kResidualScaleM = 0.2;

TEST(Residuals, BeyondThreeSigmaThereAreNone) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  const auto residuals = [&](float behind_m) {  // the wall at x = 6.13 m
    return linearise({{{6.13F + behind_m, 0.1F, 0.1F}}, {}}, map, {}, 0.1, {}).count;
  };
  EXPECT_EQ(residuals(0.29F), 1U);
  EXPECT_EQ(residuals(0.31F), 0U);
}

TEST(Residuals, WherePointsAreNoPlaneTheirGaussianCounts) {
  std::mt19937 rng(5);
  std::normal_distribution<double> unit(0.0, 1.0);
  std::vector<Eigen::Vector3f> bush;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.05 * unit(rng);
    const double y = 0.1 * unit(rng);
    bush.push_back(Eigen::Vector3d(1.0 + x, 1.0 + y, 1.0 + 0.15 * unit(rng)).cast<float>());
  }
  LocalMapConfig map_config = test::exact_map_config();
  map_config.voxel_m = 2.0;
  map_config.levels = 1;
  map_config.max_points = 10000;
  map_config.min_extent = 0.01;
  map_config.scatter_voxel_m = 0.5;
  LocalMap map(map_config);
  map.insert(bush, SE3::Identity());
  const Eigen::Vector3d point(1.03, 0.95, 1.1);
  MapScatter scatter;
  map.visit<LocalMap::Wanted::kPlanesAndScatter>(
      0, 1, [&](std::size_t) -> const Eigen::Vector3d& { return point; },
      [&](std::size_t, const Eigen::Vector3d&, const PlaneSpot& spot) {
        ASSERT_TRUE(spot.scatter);
        scatter = spot.grid->scatter_at(spot);
      });
  ASSERT_GT(scatter.variances.minCoeff(), 0.0);
  AdaptiveIcpConfig config;
  config.scatter_noise_m = 0.05;
  const NormalEquations sums = linearise({{point.cast<float>()}, {}}, map, {}, kResidualScaleM, config);
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double variance = scatter.variances[axis];
    const double share = (1.0 - 12.0 * variance / 4.0) * 0.0025 / (0.0025 + variance);
    const Eigen::Vector3d direction = scatter.axes.col(axis);
    const double e = direction.dot(point - scatter.mean);
    Vector6d J;
    J << point.cross(direction), direction;
    const double beta = share * kResidualScaleM * kResidualScaleM / (kResidualScaleM * kResidualScaleM + share * e * e);
    H += beta * J * J.transpose();
    b += beta * e * J;
  }
  EXPECT_EQ(sums.count, 3U);
  EXPECT_TRUE(sums.pose_hessian().isApprox(H, 1e-5)) << sums.pose_hessian() << "\n\n" << H;
  EXPECT_TRUE(sums.gradient().head<6>().isApprox(b, 1e-4));
}

}  // namespace
}  // namespace rilo
