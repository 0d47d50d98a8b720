// Planes of noisy points: rays, directions, rough ground, volumes.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "map/plane_grid.hpp"
#include "map/plane_points.hpp"

namespace rilo {
namespace {

using test::insert_plane;
using test::kCriteria;

constexpr double kGrazing = 0.17;  // rad: ground seen from 1.7 m above at 10 m

/// Ground z = 0 in the voxel around the origin's neighbour, seen from far along −x under kGrazing, with noise along the
/// ray: `rings` rings, `spacing_m` apart on the ground.
std::vector<InsertedPoint> ground_rings(int rings, double spacing_m, double range_noise_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> along(-0.45, 0.45);
  std::normal_distribution<double> noise(0.0, range_noise_m);
  const Eigen::Vector3d ray(std::cos(kGrazing), 0.0, -std::sin(kGrazing));
  std::vector<InsertedPoint> points;
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d ground(0.5 + spacing_m * (ring - 0.5 * (rings - 1)), 0.5 + along(rng), 0.5);
      points.push_back({ground + noise(rng) * ray, (10.0 * ray).cast<float>()});
    }
  }
  return points;
}

/// Angle (rad) of the normal found at the middle of those rings from the vertical; negative when there is no plane.
double tilt_of(const std::vector<InsertedPoint>& points, const PlaneCriteria& criteria, MapPlane& plane) {
  PlaneGrid grid(1.0, criteria);
  grid.insert(points);
  grid.refit();
  if (!grid.find({0.5, 0.5, 0.5}, plane)) {
    return -1.0;
  }
  return std::acos(std::min(1.0, std::abs(plane.normal.z())));
}

TEST(PlaneGridTest, PointsOfOneBeamAreNoPlane) {
  const PlaneCriteria blind{6, 1000, 0.1, 0.01};
  PlaneCriteria noisy = blind;
  noisy.range_noise_m = 0.02;
  noisy.angle_noise_rad = 0.001;
  const std::vector<InsertedPoint> one = ground_rings(1, 0.0, 0.02, 3);
  MapPlane plane;
  // Without knowledge of the noise the plane contains the ray: it is off by the grazing angle.
  EXPECT_NEAR(tilt_of(one, blind, plane), kGrazing, 0.02);
  EXPECT_LT(tilt_of(one, noisy, plane), 0.0);
  // Nor do they count as a Gaussian: what lies across the ring was not seen.
  PlaneGrid grid(1.0, noisy);
  grid.insert(one);
  grid.refit();
  PlaneSpot spot;
  EXPECT_NE(grid.look_up(grid.index_of({0.5, 0.5, 0.5}), spot), PlaneGrid::Kind::kScatter);
}

TEST(PlaneGridTest, ANormalIsAsReliableAsItsRaysAreSpread) {
  PlaneCriteria criteria{6, 1000, 0.1, 0.01};
  criteria.angle_noise_rad = 0.001;
  double before = 0.0;
  for (const double spacing_m : {0.1, 0.2, 0.4, 0.8}) {
    MapPlane plane;
    ASSERT_GE(tilt_of(ground_rings(2, spacing_m, 0.0, 4), criteria, plane), 0.0) << spacing_m;
    // Two rings: D = spacing · sin(grazing angle) / 2; λ² = (D² / (D² + σ²))², σ = 10 m · 1 mrad.
    const double D = 0.5 * spacing_m * std::sin(kGrazing);
    const double lambda = D * D / (D * D + 1e-4);
    EXPECT_NEAR(static_cast<double>(plane.weight), lambda * lambda, 0.02) << spacing_m;
    EXPECT_GT(static_cast<double>(plane.weight), before);
    before = static_cast<double>(plane.weight);
  }
}

TEST(PlaneGridTest, RoughGroundOfFewRingsIsUnreliable) {
  PlaneCriteria criteria{6, 1000, 0.1, 0.01};
  criteria.angle_noise_rad = 1e-6;
  // Roughness moves the returns along the ray by standard deviation s. In (range, direction across): covariance
  // (D² cot² γ + s², D² cot γ; D² cot γ, D²), D = spacing · sin γ / 2. The fit's normal makes tan γ' with the ray, the
  // regression's tan γ; λ = sin² γ' / sin² γ.
  constexpr double kSpacingM = 0.3;
  const double D = 0.5 * kSpacingM * std::sin(kGrazing);
  const double cot = 1.0 / std::tan(kGrazing);
  for (const double s : {0.03, 0.06, 0.1}) {
    double sum = 0.0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      MapPlane plane;
      ASSERT_GE(tilt_of(ground_rings(2, kSpacingM, s, seed), criteria, plane), 0.0) << s;
      sum += static_cast<double>(plane.weight);
    }
    const double fit_rad = 0.5 * std::atan2(2.0 * D * D * cot, D * D * cot * cot + s * s - D * D);
    const double lambda = std::pow(std::sin(fit_rad) / std::sin(kGrazing), 2.0);
    EXPECT_NEAR(sum / 10.0, lambda * lambda, 0.06) << s;
  }
  MapPlane plane;
  EXPECT_LT(tilt_of(ground_rings(2, kSpacingM, 0.3, 1), criteria, plane), 0.0);
  // Seen from the front, noise along the ray tilts nothing.
  std::vector<InsertedPoint> front = ground_rings(2, kSpacingM, 0.05, 1);
  for (InsertedPoint& point : front) {
    point.ray = {0.0F, 0.0F, -10.0F};
  }
  ASSERT_GE(tilt_of(front, criteria, plane), 0.0);
  EXPECT_GT(plane.weight, 0.99F);
}

TEST(PlaneGridTest, NoiseAlongTheRayDoesNotTiltTheNormal) {
  PlaneCriteria blind{6, 1000, 0.1, 0.01};
  PlaneCriteria noisy = blind;
  noisy.range_noise_m = 0.03;
  double blind_sum = 0.0;
  double noisy_sum = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto rings = ground_rings(3, 0.06, 0.03, seed);
    MapPlane plane;
    blind_sum += tilt_of(rings, blind, plane);
    noisy_sum += tilt_of(rings, noisy, plane);
  }
  // A bias of σ² sin γ cos γ / (D² + σ²) without it, D² = 2/3 · 0.06².
  EXPECT_NEAR(blind_sum / 20.0, 0.17 * 9e-4 / (24e-4 + 9e-4), 0.015);
  EXPECT_LT(noisy_sum / 20.0, 0.5 * blind_sum / 20.0);
  // Where there is no noise, none is taken off.
  MapPlane plane;
  EXPECT_NEAR(tilt_of(ground_rings(3, 0.2, 0.0, 1), noisy, plane), 0.0, 1e-6);
}

TEST(PlaneGridTest, AFullVoxelWithoutAPlaneGoesOnLearning) {
  PlaneCriteria criteria{6, 20, 0.1, 0.01};
  criteria.range_noise_m = 0.02;
  criteria.angle_noise_rad = 0.001;
  PlaneGrid grid(1.0, criteria);
  grid.insert(ground_rings(1, 0.0, 0.02, 5));  // standing: 40 points of one beam
  grid.refit();
  MapPlane plane;
  EXPECT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
  for (int ring = 0; ring < 4; ++ring) {  // driving: the ring moves over the ground
    std::vector<InsertedPoint> points = ground_rings(1, 0.0, 0.02, 6U + static_cast<unsigned>(ring));
    points.resize(5);
    for (InsertedPoint& point : points) {
      point.place.x() += 0.2 * (ring - 1.5);
    }
    grid.insert(points);
    grid.refit();
  }
  EXPECT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
}

TEST(PlaneGridTest, AVolumeIsAGaussian) {
  std::mt19937 rng(7);
  std::normal_distribution<double> unit(0.0, 1.0);
  PlaneGrid grid(4.0, PlaneCriteria{6, 100000, 0.1, 0.05});
  for (int i = 0; i < 20000; ++i) {
    grid.insert({2.0 + 0.1 * unit(rng), 2.0 + 0.2 * unit(rng), 2.0 + 0.3 * unit(rng)});
  }
  grid.refit();
  PlaneSpot spot;
  ASSERT_FALSE(grid.locate({2.0, 2.0, 2.0}, spot));
  ASSERT_EQ(grid.look_up(grid.index_of({2.0, 2.0, 2.0}), spot), PlaneGrid::Kind::kScatter);
  const MapScatter scatter = grid.scatter_at(spot);
  EXPECT_LT((scatter.mean - Eigen::Vector3d(2.0, 2.0, 2.0)).norm(), 0.02);
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = 0.1 * (axis + 1);
    EXPECT_NEAR(std::sqrt(scatter.variances[axis]), sigma, 0.1 * sigma);
    EXPECT_NEAR(std::abs(scatter.axes(axis, axis)), 1.0, 0.01);
    EXPECT_NEAR(scatter.bounded[axis], 1.0 - 12.0 * sigma * sigma / 16.0, 0.02);
  }
}

TEST(PlaneGridTest, ANormalBelowThreeTenthsOfReliabilityIsNone) {
  PlaneCriteria criteria{6, 1000, 0.1, 0.01};
  criteria.angle_noise_rad = 0.001;
  for (const double lambda : {0.27, 0.33}) {
    const double D = std::sqrt(1e-4 * lambda / (1.0 - lambda));  // as above
    MapPlane plane;
    EXPECT_EQ(tilt_of(ground_rings(2, 2.0 * D / std::sin(kGrazing), 0.0, 4), criteria, plane) >= 0.0, lambda > 0.3)
        << lambda;
  }
}

}  // namespace
}  // namespace rilo
