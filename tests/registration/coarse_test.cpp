// The coarse registration on scenes with known answers.
#include <gtest/gtest.h>

#include "registration/coarse_registration.hpp"
#include "registration/registration_scenes.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::angle_deg;
using test::distance_m;
using test::twist;

std::vector<Eigen::Vector3f> room(const SE3& T_world_sensor, std::uint64_t seed) {
  SceneSampling sampling;
  sampling.spacing_m = 0.5;
  sampling.noise_m = 0.01;
  sampling.seed = seed;
  sampling.T_world_sensor = T_world_sensor;
  auto points = make_box_room({21.3, 13.7, 6.1}, sampling);
  // A box that stands out of the middle, so that no two sides look alike.
  sampling.spacing_m = 0.3;
  SE3 corner = SE3::Identity();
  corner.translation() = Eigen::Vector3d(4.0, -3.0, -1.0);
  sampling.T_world_sensor = corner.inverse() * T_world_sensor;
  const auto box = make_box_room({2.0, 3.0, 4.0}, sampling);
  points.insert(points.end(), box.begin(), box.end());
  return points;
}

/// Long enough for a metre and fifteen degrees in a hall of twenty metres.
CoarseRegistrationConfig patient() {
  CoarseRegistrationConfig config;
  config.voxel_m = 1.0;
  config.density_radius_m = 2.0;
  config.max_iterations = 60;
  return config;
}

class KnownMotion : public ::testing::TestWithParam<Vector6d> {};

TEST_P(KnownMotion, IsRecoveredFromTheIdentity) {
  const CoarseRegistrationConfig config = patient();
  const SE3 truth = se3_exp(GetParam());
  const DistributionCloud target = make_distribution_cloud(room(SE3::Identity(), 1), config);
  const DistributionCloud source = make_distribution_cloud(room(truth, 2), config);
  const CoarseResult result = coarse_registration(source, target, SE3::Identity(), config);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(distance_m(truth, result.T_target_source), 0.05);
  EXPECT_LT(angle_deg(truth, result.T_target_source), 0.5);
  EXPECT_GT(result.pairs, source.size() / 2);
  EXPECT_GT(result.mean_weight, 0.3);
  EXPECT_LE(result.mean_weight, 1.0);
  EXPECT_LE(result.iterations, config.max_iterations);
}

INSTANTIATE_TEST_SUITE_P(Motions, KnownMotion,
                         ::testing::Values(twist(0, 0, 0, 0, 0, 0), twist(0, 0, 0, 1, 0, 0),
                                           twist(0, 0, 0, -0.6, 0.7, 0.1), twist(0, 0, 15 * test::kDegree, 0, 0, 0),
                                           twist(0, 0, -15 * test::kDegree, 0.5, -0.5, 0),
                                           twist(0.05, -0.05, 8 * test::kDegree, 0.8, 0.4, -0.2)));

TEST(CoarseRegistrationStart, AGoodInitialPoseReplacesALongWay) {
  const CoarseRegistrationConfig config = patient();
  const SE3 truth = se3_exp(twist(0, 0, 1.2, 5.0, 2.0, 0));
  const DistributionCloud target = make_distribution_cloud(room(SE3::Identity(), 1), config);
  const DistributionCloud source = make_distribution_cloud(room(truth, 2), config);
  const SE3 start = truth * se3_exp(twist(0.01, 0, 0.05, 0.3, -0.2, 0.05));
  const CoarseResult result = coarse_registration(source, target, start, config);
  EXPECT_LT(distance_m(truth, result.T_target_source), 0.1);
  EXPECT_LT(angle_deg(truth, result.T_target_source), 1.0);
}

TEST(CoarseRegistrationStart, OneIterationIsNotConverged) {
  CoarseRegistrationConfig config;
  config.max_iterations = 1;
  const DistributionCloud target = make_distribution_cloud(room(SE3::Identity(), 1), config);
  const CoarseResult result = coarse_registration(target, target, se3_exp(twist(0, 0, 0.1, 1, 0, 0)), config);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 1);
}

TEST(CoarseRegistrationStart, TheDeadlineEndsItAndItSaysSo) {
  const CoarseRegistrationConfig config;
  const DistributionCloud target = make_distribution_cloud(room(SE3::Identity(), 1), config);
  std::int64_t now_ns = 0;
  const Deadline::Clock clock = [&] { return ++now_ns; };
  const CoarseResult result =
      coarse_registration(target, target, se3_exp(twist(0, 0, 0.1, 1, 0, 0)), config, Deadline(clock, 3));
  EXPECT_TRUE(result.cut);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 3);
}

TEST(CoarseRegistrationHostile, TooFewPointsLeaveTheInitialPose) {
  const CoarseRegistrationConfig config;
  const SE3 initial = se3_exp(twist(0.1, 0.2, 0.3, 1, 2, 3));
  const DistributionCloud full = make_distribution_cloud(room(SE3::Identity(), 1), config);
  const DistributionCloud empty = make_distribution_cloud({}, config);
  const DistributionCloud one = make_distribution_cloud({{1, 2, 3}}, config);
  EXPECT_EQ(empty.size(), 0U);
  EXPECT_EQ(one.size(), 1U);
  for (const auto* source : {&empty, &one}) {
    for (const auto* target : {&full, &empty, &one}) {
      const CoarseResult result = coarse_registration(*source, *target, initial, config);
      EXPECT_FALSE(result.converged);
      EXPECT_EQ(result.T_target_source.matrix(), initial.matrix());
      EXPECT_EQ(result.iterations, 1);
      EXPECT_LE(result.pairs, 1U);
    }
  }
  EXPECT_EQ(coarse_registration(full, empty, initial, config).pairs, 0U);
}

TEST(CoarseRegistrationHostile, OneLineAndOnePlaceStayFinite) {
  const CoarseRegistrationConfig config;
  std::vector<Eigen::Vector3f> line;
  for (int i = 0; i < 100; ++i) {
    line.emplace_back(0.2F * static_cast<float>(i), 0.0F, 0.0F);
  }
  const std::vector<Eigen::Vector3f> place(100, Eigen::Vector3f(1, 2, 3));
  for (const auto& points : {line, place}) {
    const DistributionCloud cloud = make_distribution_cloud(points, config);
    const SE3 start = se3_exp(twist(0, 0, 0.02, 0.1, 0.1, 0));
    const CoarseResult result = coarse_registration(cloud, cloud, start, config);
    EXPECT_TRUE(result.T_target_source.matrix().allFinite());
    EXPECT_GE(result.mean_weight, 0.0);
    EXPECT_LE(result.mean_weight, 1.0);
  }
}

TEST(CoarseRegistrationStart, AnnealingTakesHalfOfTheIterations) {
  const CoarseRegistrationConfig config;  // 20 iterations
  const DistributionCloud target = make_distribution_cloud(room(SE3::Identity(), 1), config);
  const CoarseResult result = coarse_registration(target, target, SE3::Identity(), config);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 11) << "there from the first on";
}

TEST(DistributionClouds, LoosePointsAreLeftOutAndNeighboursAreSoughtFourTimesAsFar) {
  CoarseRegistrationConfig config;  // 2 m
  config.density_percentile = 1.5;  // of 101 points the one with the fewest around it
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 10; ++y) {
      points.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0F);
    }
  }
  points.emplace_back(0.0F, 0.0F, 15.0F);
  EXPECT_EQ(make_distribution_cloud(points, config).size(), 100U);
  // Alone, 7 m from a cluster: its neighbours are within 8 m.
  config.density_percentile = 0.0;
  points = {{0, 0, 0}, {7, 0, 0}, {7, 0.5F, 0}, {7, 0, 0.5F}, {7.5F, 0, 0}};
  EXPECT_GT(make_distribution_cloud(points, config).covariances.front().norm(), 1.0F);
  points.front().x() = -2.0F;
  EXPECT_EQ(make_distribution_cloud(points, config).covariances.front(), Eigen::Matrix3f::Zero());
}

}  // namespace
}  // namespace rilo
