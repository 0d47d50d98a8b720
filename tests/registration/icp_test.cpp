// The adaptive ICP on scenes with known answers.
#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/registration_scenes.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::angle_deg;
using test::distance_m;
using test::twist;

class ExactRoom : public ::testing::TestWithParam<Vector6d> {
 protected:
  LocalMap map_ = test::map_of(test::rimless_room(0.13, 0.0));
};

AdaptiveIcpConfig precise() {
  AdaptiveIcpConfig config;
  config.max_iterations = 100;
  config.epsilon = 1e-4;
  return config;
}

TEST_P(ExactRoom, TheKnownPoseIsFound) {
  const SE3 truth = se3_exp(GetParam());
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.23, 0.37, 1.3)), {}};
  for (const bool adaptive : {true, false}) {
    AdaptiveIcpConfig config = precise();
    config.adaptive = adaptive;
    const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.5, config);
    EXPECT_TRUE(result.converged());
    EXPECT_LT(distance_m(truth, result.state.T_odom_lidar), 1e-3);
    EXPECT_LT(angle_deg(truth, result.state.T_odom_lidar), 0.01);
    EXPECT_LT(result.residual_rms_m, 1e-3);
    EXPECT_GT(result.inliers, source.size() * 9 / 10);
    EXPECT_EQ(result.state.twist.norm(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Poses, ExactRoom,
                         ::testing::Values(twist(0, 0, 0, 0, 0, 0), twist(0, 0, 0, 0.3, 0, 0),
                                           twist(0, 0, 0, -0.1, 0.25, 0.2), twist(0, 0, 0.05, 0, 0, 0),
                                           twist(0.03, -0.04, 0.02, 0.1, -0.1, 0.15),
                                           twist(-0.02, 0.03, -0.06, -0.2, 0.2, -0.1)));

TEST_F(ExactRoom, AfterTheDeadlineOneIterationOfAllPointsIsMade) {
  const SE3 truth = se3_exp(twist(0, 0, 0.02, 0.2, 0, 0));
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.06, 0.09, 1.3)), {}};
  ASSERT_GE(source.size(), 4000U) << "begins with a stride";
  std::int64_t now_ns = 0;
  const Deadline::Clock clock = [&] { return now_ns += 1'000'000; };
  const IcpResult late = adaptive_icp(source, map_, {}, {}, 0.5, precise(), Deadline(clock, 0));
  EXPECT_EQ(late.termination, IcpTermination::kTimeLimit);
  EXPECT_EQ(late.iterations, 2) << "one with the stride, one of all points";
  EXPECT_GT(late.inliers, source.size() / 2);
  EXPECT_GT(late.last_update.norm(), 0.0);
  EXPECT_LT(distance_m(truth, late.state.T_odom_lidar), 0.2) << "nearer than the start";
  const IcpResult in_time = adaptive_icp(source, map_, {}, {}, 0.5, precise(), Deadline(clock, now_ns + 1'000'000'000));
  EXPECT_TRUE(in_time.converged());
  EXPECT_EQ(in_time.state.T_odom_lidar.matrix(),
            adaptive_icp(source, map_, {}, {}, 0.5, precise()).state.T_odom_lidar.matrix());
}

TEST_F(ExactRoom, VelocityIsFoundFromTheTimesOfThePoints) {
  MotionState truth;
  truth.T_odom_lidar = se3_exp(twist(0.01, -0.01, 0.03, 0.1, -0.1, 0.05));
  truth.twist = twist(0.1, -0.2, 0.8, 2.5, -0.6, 0.3);
  const TimedCloud source =
      test::measured_in_motion(test::seen_from(truth.T_odom_lidar, test::rimless_room(0.23, 0.37, 1.3)), truth.twist);
  const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.5, precise());
  EXPECT_TRUE(result.converged());
  EXPECT_LT(distance_m(truth.T_odom_lidar, result.state.T_odom_lidar), 1e-3);
  EXPECT_LT(angle_deg(truth.T_odom_lidar, result.state.T_odom_lidar), 0.01);
  EXPECT_LT((result.state.twist - truth.twist).norm(), 0.01);
  AdaptiveIcpConfig fixed = precise();
  fixed.refine_motion = false;
  MotionState initial;
  initial.twist = truth.twist;
  const IcpResult held = adaptive_icp(source, map_, initial, {}, 0.5, fixed);
  EXPECT_LT((held.state.twist - truth.twist).norm(), 1e-9 + 0.2 * truth.twist.norm());
  EXPECT_LT(distance_m(truth.T_odom_lidar, held.state.T_odom_lidar), 1e-3);
}

TEST_F(ExactRoom, LargeCloudsGoThroughTheStride) {
  const SE3 truth = se3_exp(twist(0.02, -0.01, 0.03, 0.1, -0.1, 0.05));
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.12, 0.37, 1.3)), {}};
  ASSERT_GT(source.size(), 8000U);
  const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.3, precise());
  EXPECT_TRUE(result.converged());
  EXPECT_GT(result.inliers, source.size() * 9 / 10);  // the last iteration looks at all points
  EXPECT_LT(distance_m(truth, result.state.T_odom_lidar), 1e-3);
}

// The bound is a share of the standard deviations, so that what is left is one, too, whatever the noise.
TEST_F(ExactRoom, ConvergedMeansNearInStandardDeviations) {
  const SE3 truth = se3_exp(twist(0.02, -0.01, 0.03, 0.1, -0.1, 0.05));
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.23, 0.37, 1.3)), {}};
  const IcpResult exact = adaptive_icp(source, map_, {}, {}, 0.3, precise());
  for (const double epsilon : {0.1, 1.0}) {
    AdaptiveIcpConfig config = precise();
    config.epsilon = epsilon;
    const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.3, config);
    EXPECT_TRUE(result.converged());
    EXPECT_LT(result.iterations, exact.iterations);
    MotionPrior at_exact;
    at_exact.state = exact.state;
    const Vector12d left = prior_error(at_exact, result.state);
    EXPECT_LT(left.dot(exact.posterior_information * left), epsilon * epsilon);
  }
}

TEST_F(ExactRoom, StopsAtTheLastIterationWithoutCallingItConverged) {
  const TimedCloud source{
      test::seen_from(se3_exp(twist(0.02, 0, 0.03, 0.2, 0.1, 0)), test::rimless_room(0.23, 0.37, 1.3)), {}};
  AdaptiveIcpConfig config = precise();
  config.max_iterations = 2;
  const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.3, config);
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.iterations, 2);
}

TEST_F(ExactRoom, CloudsThatSayNothingLeaveTheStateAloneAndFinite) {
  MotionState initial;
  initial.T_odom_lidar = se3_exp(twist(0.1, 0.2, 0.3, 0.4, 0.5, 0.6));
  initial.twist = twist(0, 0, 0.1, 1, 0, 0);
  TimedCloud in_the_air;
  for (int i = 0; i < 100; ++i) {
    in_the_air.points.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  }
  const TimedCloud one{{{6.13F, 0.0F, 0.0F}}, {}};
  for (const TimedCloud& cloud : {TimedCloud{}, one, in_the_air}) {
    const IcpResult result = adaptive_icp(cloud, map_, initial, {}, 0.3, {});
    EXPECT_FALSE(result.converged());
    EXPECT_LE(result.inliers, 1U);
    EXPECT_EQ(result.state.T_odom_lidar.matrix(), initial.T_odom_lidar.matrix());
    EXPECT_EQ(result.state.twist, initial.twist);
    EXPECT_TRUE(result.posterior_information.allFinite());
  }
  const IcpResult no_map = adaptive_icp(in_the_air, LocalMap(LocalMapConfig{}), initial, {}, 0.3, {});
  EXPECT_FALSE(no_map.converged());
  EXPECT_EQ(no_map.inliers, 0U);
}

TEST_F(ExactRoom, PointsOnOneLineMoveOnlyWhatTheySee) {
  TimedCloud line;  // on the wall x = 6.13, along y, seen 5 cm too near
  for (int i = 0; i < 200; ++i) {
    line.points.emplace_back(6.08F, -2.0F + 0.02F * static_cast<float>(i), 0.05F);
  }
  for (const double weak : {0.0, 5e-4}) {
    AdaptiveIcpConfig config;
    config.weak_direction = weak;
    const IcpResult result = adaptive_icp(line, map_, {}, {}, 0.3, config);
    EXPECT_TRUE(result.state.T_odom_lidar.matrix().allFinite());
    EXPECT_TRUE(result.state.twist.allFinite());
    EXPECT_TRUE(result.posterior_information.allFinite());
    EXPECT_LT(result.degeneracy.relative_eigenvalues[0], 1e-7);
    EXPECT_NEAR(result.state.T_odom_lidar.translation().y(), 0.0, 0.02);
    EXPECT_NEAR((result.state.T_odom_lidar * line.points[100].cast<double>()).x(), 6.13, 5e-3);
  }
}

// A direction that is observed weakly, but observed, must neither be overshot nor lost when nothing else is known.
TEST_F(ExactRoom, FadedDirectionsStillConvergeWithoutAPrior) {
  const SE3 truth = se3_exp(twist(0.01, -0.01, 0.02, 0.05, -0.05, 0.04));
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.23, 0.37, 1.3)), {}};
  const double weakest = adaptive_icp(source, map_, {}, {}, 0.3, precise()).degeneracy.relative_eigenvalues[0];
  AdaptiveIcpConfig config = precise();
  config.weak_direction = 1.5 * weakest;
  const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.3, config);
  EXPECT_TRUE(result.converged());
  EXPECT_LT(distance_m(truth, result.state.T_odom_lidar), 1e-3);
  EXPECT_LT(angle_deg(truth, result.state.T_odom_lidar), 0.01);
}

// Where the sweep and the prior disagree on a direction, fading shifts the balance to the prior and never beyond it.
TEST_F(ExactRoom, FadingLeansTowardsThePrior) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), {}};
  const double weakest = adaptive_icp(source, map_, {}, {}, 0.3, precise()).degeneracy.relative_eigenvalues[0];
  MotionPrior prior;
  prior.state.T_odom_lidar.translation() = Eigen::Vector3d(0.1, 0.1, 0.1);
  double before = 0.0;
  for (const double threshold : {0.0, 0.5 * weakest, 1.0 * weakest, 2.0 * weakest, 50.0}) {
    AdaptiveIcpConfig config = precise();
    config.weak_direction = threshold;
    prior.information = Matrix12d::Identity() * 1e2;
    const IcpResult result = adaptive_icp(source, map_, prior.state, prior, 0.3, config);
    const double towards_prior = result.state.T_odom_lidar.translation().norm();
    EXPECT_TRUE(result.converged()) << threshold;
    EXPECT_GE(towards_prior, before - 1e-6) << threshold;
    EXPECT_LE(towards_prior, prior.state.T_odom_lidar.translation().norm() + 1e-6) << threshold;
    before = towards_prior;
  }
  EXPECT_GT(before, 0.1);  // the largest threshold leaves nearly everything to the prior
}

TEST_F(ExactRoom, APriorOfCertaintyIsObeyed) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), {}};
  MotionPrior prior;
  prior.state.T_odom_lidar = se3_exp(twist(0.01, 0.0, 0.02, 0.1, -0.05, 0.02));
  prior.state.twist = twist(0, 0, 0.1, 1, 0, 0);
  prior.information = 1e14 * Matrix12d::Identity();
  const IcpResult result = adaptive_icp(source, map_, {}, prior, 0.5, precise());
  EXPECT_LT(distance_m(prior.state.T_odom_lidar, result.state.T_odom_lidar), 1e-4);
  EXPECT_LT((result.state.twist - prior.state.twist).norm(), 1e-3);
}

TEST(AdaptiveIcpCorridor, ThePriorHoldsTheAxis) {
  LocalMap map{test::exact_map_config()};
  map.set_scene_range(8.0);
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  map.insert(make_corridor(30.0, 3.1, 2.7, sampling), SE3::Identity());
  sampling.seed = 2;
  sampling.spacing_m = 0.15;
  sampling.noise_m = 0.005;
  const TimedCloud source{make_corridor(20.0, 3.1, 2.7, sampling), {}};
  MotionPrior prior;
  prior.state.T_odom_lidar.translation() = Eigen::Vector3d(0.7, 0.05, 0.0);
  prior.information = 1e3 * Matrix12d::Identity();  // 3 cm
  const IcpResult result = adaptive_icp(source, map, prior.state, prior, 0.3, {});
  EXPECT_NEAR(result.state.T_odom_lidar.translation().x(), 0.7, 1e-2);
  EXPECT_NEAR(result.state.T_odom_lidar.translation().y(), 0.0, 1e-2);
  EXPECT_LT(result.degeneracy.relative_eigenvalues[0], 1e-3);
  EXPECT_GT(result.degeneracy.relative_eigenvalues[1], 10.0 * result.degeneracy.relative_eigenvalues[0]);
}

TEST(AdaptiveIcpCorridor, TwoWallsAndAPlaneKeepWhatTheyCannotSee) {
  for (const bool walls : {true, false}) {
    LocalMap map{LocalMapConfig{}};
    map.set_scene_range(8.0);
    SceneSampling sampling;
    sampling.spacing_m = 0.06;
    map.insert(walls ? make_two_walls(20, 5.1, 4, sampling) : make_ground_plane(20, sampling), SE3::Identity());
    sampling.seed = 3;
    sampling.spacing_m = 0.2;
    const TimedCloud source{walls ? make_two_walls(15, 5.1, 3, sampling) : make_ground_plane(15, sampling), {}};
    MotionPrior prior;
    prior.state.T_odom_lidar.translation() = Eigen::Vector3d(0.3, walls ? 0.05 : 0.2, walls ? 0.2 : 0.05);
    prior.information = 10.0 * Matrix12d::Identity();
    const Eigen::Vector3d t = adaptive_icp(source, map, prior.state, prior, 0.3, {}).state.T_odom_lidar.translation();
    EXPECT_NEAR(t.x(), 0.3, 0.02);
    EXPECT_NEAR(t.y(), walls ? 0.0 : 0.2, 0.02);
    EXPECT_NEAR(t.z(), walls ? 0.2 : 0.0, 0.02);
  }
}

// 20 cm and more: no wall is within three times 3 cm. The strided cloud begins with three times that.
TEST_F(ExactRoom, ANarrowGateBeginsWide) {
  const SE3 truth = se3_exp(twist(0, 0, 0.005, 0.2, -0.2, 0.2));
  const TimedCloud source{test::seen_from(truth, test::rimless_room(0.12, 0.37, 1.3)), {}};
  ASSERT_GT(source.size(), 4000U);
  const IcpResult result = adaptive_icp(source, map_, {}, {}, 0.03, precise());
  EXPECT_TRUE(result.converged());
  EXPECT_LT(distance_m(truth, result.state.T_odom_lidar), 1e-3);
}

TEST_F(ExactRoom, AfterSixteenIterationsMatchesAreHeld) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), {}};
  AdaptiveIcpConfig config;
  config.epsilon = 0.0;  // never
  config.max_iterations = 15;
  EXPECT_FALSE(adaptive_icp(source, map_, {}, {}, 0.3, config).frozen);
  config.max_iterations = 16;
  EXPECT_TRUE(adaptive_icp(source, map_, {}, {}, 0.3, config).frozen);
}

TEST_F(ExactRoom, TheSecondHalfOfTheIterationsLooksAtAllPoints) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.12, 0.37, 1.3)), {}};
  ASSERT_GT(source.size(), 4000U);
  AdaptiveIcpConfig config;
  config.epsilon = 0.0;  // never converged
  config.max_iterations = 4;
  EXPECT_GT(adaptive_icp(source, map_, {}, {}, 0.3, config).inliers, source.size() / 2);
}

}  // namespace
}  // namespace rilo
