// III-C by hand.
#include "odometry/adaptive_threshold.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace rilo {
namespace {

SE3 moved(double metres, double yaw_rad = 0.0) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, yaw_rad));
  T.translation().x() = metres;
  return T;
}

TEST(AdaptiveThreshold, ModelDeviationIsTranslationAndBoundedRotation) {
  const AdaptiveThresholdConfig config;  // σ_max 1 m, β 2
  EXPECT_NEAR(model_deviation_m(moved(1.0), moved(1.3), config), 0.3, 1e-12);
  EXPECT_NEAR(model_deviation_m(moved(0.0), moved(0.0, 0.25), config), std::tanh(0.5), 1e-12);
}

TEST(AdaptiveThreshold, RootMeanSquareOfDeviationsWeightedBySteadiness) {
  AdaptiveThresholdConfig config;
  config.forgetting = 1.0;  // the paper's mean over all sweeps
  AdaptiveThreshold threshold(config);
  EXPECT_DOUBLE_EQ(threshold.sigma_th_m(), config.initial_m);
  threshold.update(moved(0.0), moved(0.3), Eigen::Vector3d::Zero());
  EXPECT_NEAR(threshold.sigma_th_m(), 0.3, 1e-12);
  // The acceleration changes by 1.5 m: γ = exp(−1.5 / 1.5).
  threshold.update(moved(0.0), moved(0.4), Eigen::Vector3d(1.5, 0.0, 0.0));
  EXPECT_NEAR(threshold.gamma(), std::exp(-1.0), 1e-12);
  EXPECT_NEAR(threshold.sigma_th_m(), std::sqrt((0.09 + std::exp(-1.0) * 0.16) / 2.0), 1e-12);
}

TEST(AdaptiveThreshold, ForgetsAndWidensAfterFailures) {
  AdaptiveThresholdConfig config;
  config.forgetting = 0.5;
  AdaptiveThreshold threshold(config);
  threshold.update(moved(0.0), moved(0.4), Eigen::Vector3d::Zero());
  threshold.update(moved(0.0), moved(0.1), Eigen::Vector3d::Zero());
  const double sigma = std::sqrt((0.5 * 0.16 + 0.01) / 1.5);
  EXPECT_NEAR(threshold.sigma_th_m(), sigma, 1e-12);
  threshold.widen();
  EXPECT_NEAR(threshold.sigma_th_m(), 2.0 * sigma, 1e-12);
  EXPECT_NEAR(threshold.usual_sigma_th_m(), sigma, 1e-12);
  threshold.update(moved(0.0), moved(0.0), Eigen::Vector3d::Zero());
  EXPECT_LT(threshold.sigma_th_m(), sigma);
}

TEST(AdaptiveThreshold, WhatCountsIsTheChangeOfTheAcceleration) {
  AdaptiveThreshold threshold({});
  const Eigen::Vector3d steady(1.5, 0.0, 0.0);
  threshold.update(moved(0.0), moved(0.3), steady);
  EXPECT_NEAR(threshold.gamma(), std::exp(-1.0), 1e-12);
  threshold.update(moved(0.0), moved(0.3), steady);
  EXPECT_EQ(threshold.gamma(), 1.0);
}

TEST(AdaptiveThreshold, StaysWithinItsBoundsAndGrowsAtMost64Times) {
  AdaptiveThresholdConfig config;
  AdaptiveThreshold threshold(config);
  threshold.update(moved(0.0), moved(0.001), Eigen::Vector3d::Zero());
  EXPECT_EQ(threshold.sigma_th_m(), config.floor_m);
  threshold.reset();
  threshold.update(moved(0.0), moved(5.0), Eigen::Vector3d::Zero());
  EXPECT_EQ(threshold.sigma_th_m(), config.ceiling_m);
  config.ceiling_m = 1e6;
  AdaptiveThreshold high(config);
  for (int lost = 0; lost < 10; ++lost) {
    high.widen();
  }
  EXPECT_NEAR(high.sigma_th_m(), 64.0 * config.initial_m, 1e-9);
}

}  // namespace
}  // namespace rilo
