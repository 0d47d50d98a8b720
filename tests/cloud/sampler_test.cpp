// Voxel downsampling of one cloud and of a whole run.
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/random_points.hpp"
#include "cloud/voxel_sampler.hpp"
#include "geometry/voxel_key.hpp"
#include "rilo/cloud/thinned_map.hpp"

namespace rilo {
namespace {

using test::random_points;
using Points = std::vector<Eigen::Vector3f>;

std::vector<std::uint32_t> naive_sample(const Points& points, double voxel_m) {
  std::set<std::uint64_t> seen;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (seen.insert(voxel_key(voxel_of(points[i], 1.0 / voxel_m))).second) {
      kept.push_back(i);
    }
  }
  return kept;
}

TEST(VoxelSamplerTest, KeepsTheFirstPointOfEveryVoxel) {
  const Points points = {
      {0.1F, 0.1F, 0.1F}, {0.9F, 0.9F, 0.9F}, {-0.1F, 0.1F, 0.1F}, {1.0F, 0.0F, 0.0F}, {-0.9F, 0.2F, 0.2F}};
  VoxelSampler sampler;
  EXPECT_EQ(sampler.sample(points, 1.0), (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST(VoxelSamplerTest, NothingInNothingOut) {
  VoxelSampler sampler;
  EXPECT_TRUE(sampler.sample({}, 0.5).empty());
  EXPECT_EQ(sampler.sample({Eigen::Vector3f::Zero()}, 0.5).size(), 1U);
  EXPECT_TRUE(sampler.sample({}, 0.5).empty());
}

TEST(VoxelSamplerTest, CopiesOfOnePointAreOnePoint) {
  VoxelSampler sampler;
  EXPECT_EQ(sampler.sample(Points(1000, Eigen::Vector3f(-3.0F, 2.0F, 1.0F)), 0.1), (std::vector<std::uint32_t>{0}));
}

TEST(VoxelSamplerTest, EqualsASetOverManyCallsOnOneTable) {
  VoxelSampler sampler;
  std::mt19937 rng(11);
  for (unsigned call = 0; call < 200; ++call) {
    // Sizes go up and down, so that the table grows at times and holds old marks at others.
    const Points points = random_points(std::uniform_int_distribution<std::size_t>(0, 3000)(rng), 5.0F, call);
    const double voxel_m = std::uniform_real_distribution<double>(0.05, 3.0)(rng);
    ASSERT_EQ(sampler.sample(points, voxel_m), naive_sample(points, voxel_m)) << "call " << call;
  }
}

TEST(ThinnedMapTest, KeepsOnePointAVoxelInTheOdometryFrame) {
  SE3 T_odom_lidar = SE3::Identity();
  T_odom_lidar.translation() = Eigen::Vector3d(10.0, 0.0, 0.0);
  T_odom_lidar.linear() = so3_exp({0.0, 0.0, 1.5707963267948966});
  ThinnedMap map(0.5);
  EXPECT_TRUE(map.points().empty());
  map.add({{1.0F, 0.1F, 0.1F}, {1.1F, 0.1F, 0.1F}}, T_odom_lidar);
  ASSERT_EQ(map.points().size(), 1U);
  EXPECT_TRUE(map.points()[0].isApprox(Eigen::Vector3f(9.9F, 1.0F, 0.1F), 1e-5F));
  // The same place seen from elsewhere adds nothing, a new place does.
  map.add({{9.8F, 1.2F, 0.2F}, {-5.0F, 0.0F, 0.0F}}, SE3::Identity());
  EXPECT_EQ(map.points().size(), 2U);
}

TEST(ThinnedMapTest, IntensitiesAndNormalsTowardsTheSensor) {
  // A floor two metres below and a wall four metres ahead, both seen from the origin.
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) {
      const float u = 0.2F * static_cast<float>(i) + 0.1F;
      const float v = 0.2F * static_cast<float>(k) + 0.1F;
      points.emplace_back(u, v, -2.05F);
      points.emplace_back(8.05F, v, u);
    }
  }
  std::vector<float> intensities(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) intensities[i] = static_cast<float>(i % 2);
  points.emplace_back(50.0F, 50.0F, 50.0F);  // nothing near it
  intensities.push_back(9.0F);
  ThinnedMap map(0.2);
  map.add(points, SE3::Identity(), intensities);
  EXPECT_TRUE(map.cloud(false).normals.empty());
  const MapCloud cloud = map.cloud(true);
  ASSERT_EQ(cloud.points.size(), points.size());
  EXPECT_EQ(cloud.intensities, intensities);
  ASSERT_EQ(cloud.normals.size(), points.size());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector3f expected = i % 2 == 0 ? Eigen::Vector3f(0, 0, 1) : Eigen::Vector3f(-1, 0, 0);
    EXPECT_TRUE(cloud.normals[i].isApprox(expected, 1e-3F)) << i << ": " << cloud.normals[i].transpose();
  }
  EXPECT_EQ(cloud.normals.back(), Eigen::Vector3f::Zero());
}

TEST(ThinnedMapTest, IntensitiesAreThoseOfAllPointsOrNone) {
  ThinnedMap map(0.5);
  map.add({{1.0F, 0.0F, 0.0F}}, SE3::Identity(), {3.0F});
  EXPECT_EQ(map.cloud(false).intensities, std::vector<float>{3.0F});
  map.add({{2.0F, 0.0F, 0.0F}}, SE3::Identity());
  map.add({{3.0F, 0.0F, 0.0F}}, SE3::Identity(), {5.0F});
  EXPECT_EQ(map.cloud(false).points.size(), 3U);
  EXPECT_TRUE(map.cloud(false).intensities.empty());
}

TEST(ThinnedMapTest, APointAVoxelOnAllSidesOfTheOrigin) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<float> any(-9.0F, 9.0F);
  constexpr double kVoxelM = 0.25;
  ThinnedMap map(kVoxelM);
  std::set<std::array<int, 3>> voxels;
  for (int sweep = 0; sweep < 5; ++sweep) {
    std::vector<Eigen::Vector3f> points(20000);
    for (Eigen::Vector3f& p : points) {
      p = {any(rng), any(rng), any(rng)};
      const Eigen::Vector3i voxel = (p.cast<double>() / kVoxelM).array().floor().matrix().cast<int>();
      voxels.insert({voxel.x(), voxel.y(), voxel.z()});
    }
    map.add(points, SE3::Identity());
    ASSERT_EQ(map.size(), voxels.size());
  }
}

TEST(ThinnedMapTest, WhatMakesNoMapIsRefused) {
  for (const double voxel_m : {0.0, -1.0, 1e-4, 101.0, std::nan("")}) {
    EXPECT_THROW(ThinnedMap{voxel_m}, std::invalid_argument) << voxel_m;
  }
  ThinnedMap map(0.2);
  EXPECT_THROW(map.add({{1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}}, SE3::Identity(), {3.0F}), std::invalid_argument);
}

TEST(ThinnedMapTest, ALineHasNoNormals) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 30; ++i) points.emplace_back(static_cast<float>(i), 0.05F, 0.05F);
  ThinnedMap map(0.5);
  map.add(points, SE3::Identity());
  for (const Eigen::Vector3f& normal : map.cloud(true).normals) EXPECT_EQ(normal, Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace rilo
