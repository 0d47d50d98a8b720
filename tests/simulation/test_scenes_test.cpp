#include "simulation/test_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace rilo {
namespace {

TEST(TestScenes, BoxRoomHasSixFaces) {
  const Eigen::Vector3d size(10, 6, 3);
  const auto cloud = make_box_room(size);
  std::set<int> faces;
  for (const Eigen::Vector3f& p : cloud) {
    const Eigen::Vector3d off = 0.5 * size - p.cast<double>().cwiseAbs();
    int axis = 0;
    EXPECT_NEAR(off.minCoeff(&axis), 0, 1e-6);
    faces.insert(2 * axis + (p[axis] > 0 ? 1 : 0));
  }
  EXPECT_EQ(faces.size(), 6U);
  EXPECT_EQ(cloud.size(), 2U * (30 * 15 + 50 * 15 + 50 * 30));  // 0.2 m apart
}

TEST(TestScenes, NoiseIsAlongTheNormalAndHasItsDeviation) {
  SceneSampling sampling;
  sampling.noise_m = 0.02;
  const auto cloud = make_ground_plane(40, sampling);
  double square = 0;
  for (const Eigen::Vector3f& p : cloud) {
    EXPECT_LE(std::max(std::abs(p.x()), std::abs(p.y())), 20.0F);
    square += std::pow(static_cast<double>(p.z()) + 1, 2);
  }
  EXPECT_EQ(cloud.size(), 200U * 200U);
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(cloud.size())), 0.02, 0.0005);
}

TEST(TestScenes, CorridorAndWallsLieWhereTheyShould) {
  for (const Eigen::Vector3f& p : make_corridor(20, 2.4, 2.8)) {
    const double floor = std::abs(static_cast<double>(p.z()) + 1);
    const double wall = std::abs(std::abs(static_cast<double>(p.y())) - 1.2);
    EXPECT_NEAR(std::min(floor, wall), 0, 1e-6);
    EXPECT_LE(std::abs(p.x()), 10.0F);
    EXPECT_LE(p.z(), 1.8F);
  }
  for (const Eigen::Vector3f& p : make_two_walls(20, 8, 4)) {
    EXPECT_NEAR(std::abs(p.y()), 4.0F, 1e-6F);
    EXPECT_LE(std::abs(p.z()), 2.0F);
  }
}

TEST(TestScenes, AreSeenFromTheSensor) {
  SceneSampling sampling;
  const auto world = make_box_room({8, 8, 4}, sampling);
  sampling.T_world_sensor.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  sampling.T_world_sensor.translation() = Eigen::Vector3d(0.5, -1, 0.2);
  const auto seen = make_box_room({8, 8, 4}, sampling);
  ASSERT_EQ(seen.size(), world.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_LT((sampling.T_world_sensor * seen[i].cast<double>() - world[i].cast<double>()).norm(), 2e-6);
  }
}

TEST(TestScenes, SeedsChooseOtherSamples) {
  SceneSampling other;
  other.seed = 2;
  EXPECT_EQ(make_ground_plane(4), make_ground_plane(4));
  EXPECT_NE(make_ground_plane(4), make_ground_plane(4, other));
  other.spacing_m = 0;
  EXPECT_THROW(make_ground_plane(4, other), std::invalid_argument);
}

}  // namespace
}  // namespace rilo
