// What a voxel makes of more and more points: when it is fitted again, what it forgets, when it is full.
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

TEST(PlaneRefitTest, AFullVoxelTakesNoMore) {
  PlaneGrid grid(1.0, PlaneCriteria{6, 20, 0.1, 0.05});
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 20, 0.0, 6);
  std::vector<Eigen::Vector3f> before;
  grid.centroids(before);
  insert_plane(grid, {0.5, 0.5, 0.9}, Eigen::Vector3d::UnitZ(), 500, 0.0, 7);
  grid.refit();
  std::vector<Eigen::Vector3f> after;
  grid.centroids(after);
  EXPECT_EQ(before, after);
  MapPlane plane;
  ASSERT_TRUE(grid.find(centre, plane));
  EXPECT_NEAR(plane.point.z(), 0.5, 1e-6);
}

TEST(PlaneRefitTest, RefitFollowsTheEvidenceAndDropsAPlaneThatWasNone) {
  PlaneGrid grid(1.0, kCriteria);
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 10, 0.0, 8);
  grid.refit();
  MapPlane plane;
  ASSERT_TRUE(grid.find(centre, plane));
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 80; ++i) {
    grid.insert({unit(rng), unit(rng), unit(rng)});
  }
  grid.refit();
  EXPECT_FALSE(grid.find(centre, plane));
}

TEST(PlaneRefitTest, WhatAVoxelForgetsLeavesTheRangeOfItsPoints) {
  PlaneCriteria criteria{6, 20, 0.1, 0.05};
  criteria.angle_noise_rad = 0.02;
  PlaneGrid grid(1.0, criteria);
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> side(0.1, 0.9);
  for (int i = 0; i < 100; ++i) {  // a volume first, then a floor, 10 m away
    const double x = side(rng);
    const double y = side(rng);
    const double z = i < 20 ? side(rng) : 0.5;
    grid.insert(InsertedPoint{{x, y, z}, {0.0F, 0.0F, -10.0F}});
    grid.refit();
  }
  MapPlane plane;
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
  const double across = 0.64 / 12.0;  // m², that of the directions 0.2 m squared
  EXPECT_NEAR(static_cast<double>(plane.weight), std::pow(across / (across + 0.04), 2), 0.12);
}

// All that a voxel keeps moves: the plane at once, and, when more points come, the moments that it is fitted to.
TEST(PlaneRefitTest, AShiftInElevationIsOneOfPlaneAndPoints) {
  const auto points_at = [](double z, int count, unsigned seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> side(0.1, 0.9);
    std::vector<InsertedPoint> points;
    for (int i = 0; i < count; ++i) {
      const double x = side(rng);
      const double y = side(rng);
      points.push_back({{x, y, z + (i % 2 == 0 ? 0.05 : -0.05)}, Eigen::Vector3f::Zero(), {0.0F, 0.0F, 10.0F}});
    }
    return points;
  };
  PlaneGrid grid(1.0, kCriteria);
  grid.insert(points_at(0.5, 20, 1));
  grid.refit();
  // The points rise by 10 m/rad, the sensor by 2 m/rad.
  grid.shift_elevation(0.025, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {0.0, 0.0, 2.0}});
  MapPlane plane;
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.7}, plane));
  EXPECT_NEAR(plane.point.z(), 0.7, 1e-6);
  grid.insert(points_at(0.7, 20, 2));
  grid.refit();
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.7}, plane));
  EXPECT_NEAR(plane.point.z(), 0.7, 1e-6);
  EXPECT_NEAR(std::abs(plane.normal.z()), 1.0, 0.05);
  EXPECT_NEAR(plane.thickness_m, 0.05F, 0.005F);
}

// Points straight ahead at 10 m turn about the sensor's y axis; those that are no plane do so with all their axes.
TEST(PlaneRefitTest, AShiftInElevationTurnsTheAxesOfScatteredPoints) {
  PlaneGrid grid(1.0, PlaneCriteria{6, 20, 0.1, 0.05});
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d from_centre((corner & 1) != 0 ? 0.25 : -0.25, (corner & 2) != 0 ? 0.4 : -0.4,
                                      (corner & 4) != 0 ? 0.15 : -0.15);
    grid.insert({Eigen::Vector3d::Constant(0.5) + from_centre, {10.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 10.0F}});
  }
  grid.refit();
  PlaneSpot spot;
  ASSERT_EQ(grid.look_up(grid.index_of({0.5, 0.5, 0.5}), spot), PlaneGrid::Kind::kScatter);
  constexpr double kAngle = 0.2;
  grid.shift_elevation(kAngle, {});
  const Eigen::Matrix3d axes = grid.scatter_at(spot).axes;
  EXPECT_NEAR(std::abs(axes.col(0).dot(Eigen::Vector3d(-std::sin(kAngle), 0.0, std::cos(kAngle)))), 1.0, 1e-5);
  EXPECT_NEAR(std::abs(axes.col(1).dot(Eigen::Vector3d(std::cos(kAngle), 0.0, std::sin(kAngle)))), 1.0, 1e-5);
  EXPECT_NEAR(std::abs(axes.col(2).y()), 1.0, 1e-5);
}

TEST(PlaneRefitTest, WhatAVoxelForgetsDoesNotChangeItsMeans) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> side(0.1, 0.9);
  PlaneGrid grid(1.0, PlaneCriteria{6, 20, 0.1, 0.05});
  for (int i = 0; i < 50; ++i) {  // a volume: it forgets three times
    const double x = side(rng);
    const double y = side(rng);
    grid.insert({{x, y, side(rng)}, Eigen::Vector3f::Zero(), {1.0F, 2.0F, 3.0F}});
    grid.refit();
  }
  PlaneSpot spot;
  ASSERT_EQ(grid.look_up(grid.index_of({0.5, 0.5, 0.5}), spot), PlaneGrid::Kind::kScatter);
  EXPECT_TRUE(grid.elevation_jacobian_at(spot, {0.5, 0.5, 0.5}, {}).isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-5));
  const MapScatter scatter = grid.scatter_at(spot);
  EXPECT_NEAR(scatter.mean.x(), 0.5, 0.2);
  EXPECT_NEAR(scatter.variances.sum(), 3.0 * 0.64 / 12.0, 0.06);
}

TEST(PlaneRefitTest, APlaneIsFittedAgainWhenItsPointsHaveGrownByHalf) {
  PlaneGrid grid(1.0, kCriteria);
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 20, 0.0, 1);
  grid.refit();
  const auto height = [&] {
    MapPlane plane;
    return grid.find({0.5, 0.5, 0.5}, plane) ? plane.point.z() : -1.0;
  };
  const double before = height();
  insert_plane(grid, {0.5, 0.5, 0.51}, Eigen::Vector3d::UnitZ(), 9, 0.0, 2);
  grid.refit();
  EXPECT_EQ(height(), before);
  insert_plane(grid, {0.5, 0.5, 0.51}, Eigen::Vector3d::UnitZ(), 1, 0.0, 3);
  grid.refit();
  EXPECT_NEAR(height(), 0.5 + 0.01 / 3.0, 1e-5);
}

TEST(PlaneRefitTest, AFullVoxelThatProvesToBeNoPlaneGoesOnLearning) {
  PlaneGrid grid(1.0, PlaneCriteria{6, 20, 0.1, 0.05});
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 10, 0.0, 1);
  grid.refit();
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 30; ++i) {  // until it is full, and then some
    const double x = unit(rng);
    const double y = unit(rng);
    grid.insert({x, y, unit(rng)});
  }
  grid.refit();
  MapPlane plane;
  ASSERT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
  std::uniform_real_distribution<double> side(0.1, 0.9);
  for (int round = 0; round < 20; ++round) {
    std::vector<InsertedPoint> floor;
    for (int i = 0; i < 10; ++i) {
      const double x = side(rng);
      floor.push_back({{x, side(rng), 0.3}});
    }
    grid.insert(floor);
    grid.refit();
  }
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_NEAR(plane.point.z(), 0.3, 0.02);
}

}  // namespace
}  // namespace rilo
