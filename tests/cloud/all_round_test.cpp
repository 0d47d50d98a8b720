// Sweeps of sensors that turn.
#include "cloud/all_round.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace rilo::test {
namespace {

/// One point in the middle of each of the first `sectors` ranges of 10°.
std::vector<Eigen::Vector3f> ring(int sectors, double radius_m) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < sectors; ++k) {
    const double azimuth = (10 * k + 5) * std::numbers::pi / 180;
    points.emplace_back(static_cast<float>(radius_m * std::cos(azimuth)),
                        static_cast<float>(radius_m * std::sin(azimuth)), 0.5F);
  }
  return points;
}

TEST(AllRound, NearlyAllDirectionsAreSeen) {
  EXPECT_TRUE(all_round(ring(36, 8)));
  EXPECT_TRUE(all_round(ring(33, 8)));
  EXPECT_FALSE(all_round(ring(32, 8)));
  EXPECT_FALSE(all_round({}));
}

TEST(AllRound, WhatDidNotReturnHasNoDirection) {
  std::vector<Eigen::Vector3f> points = ring(8, 8);
  for (const Eigen::Vector3f& p : ring(36, 0.005)) points.push_back(p);
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F);
  EXPECT_FALSE(all_round(points));
}

}  // namespace
}  // namespace rilo::test
