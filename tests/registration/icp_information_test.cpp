// How much a registration says it knows: the residuals, their noise, the prior.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

class IcpInformation : public ::testing::Test {
 protected:
  LocalMap map_ = test::map_of(test::rimless_room(0.13, 0.0));
};

// One residual in a hundred counts as independent, with their variance or that of the least noise.
TEST_F(IcpInformation, InformationIsThatOfAHundredthOfTheResiduals) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), {}};
  AdaptiveIcpConfig config;
  config.max_iterations = 1;
  config.coarse_stride = 1;
  for (const double off_m : {0.0, 0.1}) {
    MotionState state;
    state.T_odom_lidar.translation().setConstant(off_m);
    const NormalEquations sums = linearise(source, map_, state, 0.3, config);
    const double variance = std::max(sums.squared_error / sums.weight, 0.02 * 0.02);
    EXPECT_NEAR(std::sqrt(variance), off_m > 0.0 ? 0.1 : 0.02, 1e-3);
    const IcpResult result = adaptive_icp(source, map_, state, {}, 0.3, config);
    EXPECT_TRUE(result.lidar_information.isApprox(0.01 / variance * sums.pose_hessian(), 1e-9)) << off_m;
  }
}

TEST_F(IcpInformation, InformationOfAStridedCloudIsThatOfAll) {
  const TimedCloud source{test::seen_from(SE3::Identity(), test::rimless_room(0.12, 0.37, 1.3)), {}};
  ASSERT_GT(source.size(), 4000U);
  AdaptiveIcpConfig config;
  config.max_iterations = 1;
  const IcpResult strided = adaptive_icp(source, map_, {}, {}, 0.3, config);
  config.coarse_stride = 1;
  const IcpResult all = adaptive_icp(source, map_, {}, {}, 0.3, config);
  EXPECT_NEAR(strided.lidar_information.trace() / all.lidar_information.trace(), 1.0, 0.05);
}

TEST_F(IcpInformation, SweepAndPriorAddUp) {
  const TimedCloud source =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), Vector6d::Zero());
  MotionPrior prior;
  prior.information = 50.0 * Matrix12d::Identity();
  const IcpResult result = adaptive_icp(source, map_, {}, prior, 0.3, {});
  const Matrix6d pose = result.sweep_information.topLeftCorner<6, 6>();
  EXPECT_TRUE(pose.isApprox(result.lidar_information, 1e-3)) << "nothing is weak";
  EXPECT_TRUE(result.posterior_information.isApprox(result.sweep_information + prior.information, 1e-12));
}

// Along a direction that counts as not seen the sweep says nothing of the velocity either.
TEST_F(IcpInformation, WhatIsLeftToThePriorIsLeftInTheVelocityToo) {
  const TimedCloud source =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.23, 0.37, 1.3)), Vector6d::Zero());
  MotionPrior prior;
  prior.information = 50.0 * Matrix12d::Identity();
  AdaptiveIcpConfig config;
  config.weak_direction = 50.0;  // relative eigenvalues are at most 1: nothing counts as seen
  const IcpResult result = adaptive_icp(source, map_, {}, prior, 0.3, config);
  EXPECT_GT(result.lidar_information.norm(), 1.0);
  EXPECT_TRUE(result.sweep_information.isZero(1e-9)) << result.sweep_information.diagonal().transpose();
  EXPECT_TRUE(result.posterior_information.isApprox(prior.information, 1e-9));
}

}  // namespace
}  // namespace rilo
