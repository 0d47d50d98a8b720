// One level of the map: planes and look-up across faces.
#include "map/plane_grid.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "map/plane_points.hpp"

namespace rilo {
namespace {

using test::insert_plane;
using test::kCriteria;

TEST(PlaneGridTest, EmptyGridHasNothing) {
  PlaneGrid grid(1.0, kCriteria);
  MapPlane plane;
  EXPECT_EQ(grid.size(), 0U);
  EXPECT_EQ(grid.voxel_m(), 1.0);
  EXPECT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_FALSE(grid.occupied({0.5, 0.5, 0.5}));
  grid.evict(Eigen::Vector3d::Zero(), 1.0);
  grid.refit();
  std::vector<Eigen::Vector3f> out;
  grid.centroids(out);
  EXPECT_TRUE(out.empty());
}

TEST(PlaneGridTest, ExactPlanes) {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  for (unsigned i = 0; i < 100; ++i) {
    const Eigen::Vector3d n = Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
    const Eigen::Vector3d centre(-7.5, 1000.5, 3.5);
    PlaneGrid grid(1.0, kCriteria);
    insert_plane(grid, centre, n, 50, 0.0, i);
    grid.refit();
    MapPlane plane;
    ASSERT_TRUE(grid.find(centre, plane));
    EXPECT_GT(std::abs(plane.normal.dot(n)), 1.0 - 1e-6);
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-6);
    EXPECT_NEAR((plane.point - centre).dot(n), 0.0, 1e-5);
    EXPECT_LT(plane.thickness_m, 1e-3F);
  }
}

TEST(PlaneGridTest, NoisyPlaneHasItsThickness) {
  constexpr double kNoise = 0.02;
  PlaneGrid grid(1.0, PlaneCriteria{6, 2000, 0.1, 0.05});
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  insert_plane(grid, {0.5, 0.5, 0.5}, n, 2000, kNoise, 2);
  grid.refit();
  MapPlane plane;
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_NEAR(plane.thickness_m, kNoise, 0.002);
  EXPECT_GT(std::abs(plane.normal.dot(n)), std::cos(0.02));
  EXPECT_NEAR((plane.point - Eigen::Vector3d(0.5, 0.5, 0.5)).dot(n), 0.0, 0.002);
}

TEST(PlaneGridTest, LinesClumpsAndVolumesAreNoPlanes) {
  PlaneGrid grid(1.0, kCriteria);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 50; ++i) {
    const double s = unit(rng);
    grid.insert({s, 0.3 + 0.2 * s, 0.5});                                 // collinear
    grid.insert({5.5, 0.5, 0.5});                                         // one place
    grid.insert({10.0 + unit(rng), unit(rng), unit(rng)});                // volume
    grid.insert({15.5 + 0.04 * unit(rng), 0.5 + 0.04 * unit(rng), 0.5});  // flat, too small to have a direction
  }
  grid.refit();
  MapPlane plane;
  for (const double x : {0.5, 5.5, 10.5, 15.5}) {
    EXPECT_TRUE(grid.occupied({x, 0.5, 0.5})) << x;
    EXPECT_FALSE(grid.find({x, 0.5, 0.5}, plane)) << x;
  }
}

TEST(PlaneGridTest, TooFewPointsAreNoPlaneAndPlanesNeedARefit) {
  PlaneGrid grid(1.0, kCriteria);
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  MapPlane plane;
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 5, 0.0, 4);
  grid.refit();
  EXPECT_FALSE(grid.find(centre, plane));
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 1, 0.0, 5);
  EXPECT_FALSE(grid.find(centre, plane));
  grid.refit();
  EXPECT_TRUE(grid.find(centre, plane));
}

TEST(PlaneGridTest, AWallOnAFaceIsFoundFromBothSides) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double wall : {-2.0, 0.0, 3.0}) {
      Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.5);
      centre[axis] = wall;  // exactly on the face
      PlaneGrid grid(1.0, kCriteria);
      insert_plane(grid, centre, Eigen::Vector3d::Unit(axis), 50, 0.0, 10);
      grid.refit();
      for (const double off : {-0.19, -0.01, -1e-9, 0.0, 1e-9, 0.01, 0.19}) {
        MapPlane plane;
        ASSERT_TRUE(grid.find(centre + off * Eigen::Vector3d::Unit(axis), plane)) << axis << ' ' << wall << ' ' << off;
        EXPECT_NEAR(plane.point[axis], wall, 1e-6);
        EXPECT_NEAR(std::abs(plane.normal[axis]), 1.0, 1e-6);
      }
      MapPlane plane;
      EXPECT_FALSE(grid.find(centre - 0.21 * Eigen::Vector3d::Unit(axis), plane)) << "farther than a fifth";
    }
  }
}

TEST(PlaneGridTest, TheFallbackIsTheNearestFaceOnly) {
  PlaneGrid grid(1.0, kCriteria);
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 50, 0.0, 11);
  grid.refit();
  MapPlane plane;
  EXPECT_TRUE(grid.find({1.1, 0.5, 0.5}, plane));
  EXPECT_TRUE(grid.find({0.5, -0.1, 0.5}, plane));
  EXPECT_FALSE(grid.find({1.1, 0.05, 0.5}, plane));  // nearer to the face at y = 0
  EXPECT_FALSE(grid.find({1.1, 1.1, 0.5}, plane));   // across an edge
}

/// Pairs of points `half_m` above and below the middle of the voxel around the origin's neighbour, on a lattice.
std::vector<InsertedPoint> slab(double half_m) {
  std::vector<InsertedPoint> points;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (const double side : {-1.0, 1.0}) {
        points.push_back({{0.5 + 0.2 * x, 0.5 + 0.2 * y, 0.5 + side * half_m}, {0.0F, 0.0F, -10.0F}});
      }
    }
  }
  return points;  // variance 0.08 m² along x and y
}

TEST(PlaneGridTest, APlaneIsThinnerThanATenthOfItsVariance) {
  for (const double ratio : {0.09, 0.11}) {
    PlaneGrid grid(1.0, kCriteria);
    grid.insert(slab(std::sqrt(0.08 * ratio)));
    grid.refit();
    MapPlane plane;
    EXPECT_EQ(grid.find({0.5, 0.5, 0.5}, plane), ratio < 0.1) << ratio;
  }
}

// Knowing the noise straightens normals; what is measured of the spread of points is with their noise.
TEST(PlaneGridTest, ThicknessAndVariancesAreThoseOfThePoints) {
  PlaneCriteria criteria = kCriteria;
  criteria.range_noise_m = 0.02;
  PlaneGrid thin(1.0, criteria);
  thin.insert(slab(0.03));
  thin.refit();
  MapPlane plane;
  ASSERT_TRUE(thin.find({0.5, 0.5, 0.5}, plane));
  EXPECT_NEAR(plane.thickness_m, 0.03F, 1e-5F);
  criteria.range_noise_m = 0.1;
  PlaneGrid thick(1.0, criteria);
  std::vector<InsertedPoint> from_the_side = slab(0.2);
  for (InsertedPoint& point : from_the_side) {
    point.ray = {10.0F, 0.0F, 0.0F};
  }
  thick.insert(from_the_side);
  thick.refit();
  PlaneSpot spot;
  ASSERT_EQ(thick.look_up(thick.index_of({0.5, 0.5, 0.5}), spot), PlaneGrid::Kind::kScatter);
  EXPECT_TRUE(thick.scatter_at(spot).variances.isApprox(Eigen::Vector3d(0.04, 0.08, 0.08), 1e-4));
}

}  // namespace
}  // namespace rilo
