// Motion to and fro within a sweep, as the residuals show it.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "registration/registration_scenes.hpp"
#include "registration/uneven_motion.hpp"

namespace rilo {
namespace {

constexpr double kUnevenNoiseShare = 0.08;
constexpr double kUnevenSigmaM = 0.2;

class UnevenMotion : public ::testing::Test {
 protected:
  /// Of a sensor at rest but for `swing(offset_s)`, on top of `velocity`; the registration has found the velocity.
  template <typename Swing>
  Vector6d of(const Vector6d& velocity, const SE3& T, const Swing& swing) const {
    TimedCloud source = test::measured_in_motion(test::seen_from(T, test::rimless_room(0.11, 0.37, 1.3)), velocity);
    for (std::size_t i = 0; i < source.size(); ++i) {
      source.points[i] -= swing(static_cast<double>(source.offsets_s[i])).template cast<float>();
    }
    IcpResult icp;
    icp.state = {T, velocity};
    return uneven_motion(source, map_, icp, kUnevenSigmaM, {}, kUnevenNoiseShare, 1);
  }

  LocalMap map_ = test::map_of(test::rimless_room(0.13, 0.0));
};

Eigen::Vector3d still(double /*offset_s*/) { return Eigen::Vector3d::Zero(); }

TEST_F(UnevenMotion, AConstantVelocityLeavesNothing) {
  const Vector6d xi = of(test::twist(0.1, -0.2, 0.8, 2.5, -0.6, 0.3), SE3::Identity(), still);
  EXPECT_LT(xi.head<3>().maxCoeff(), 1e-7);
  EXPECT_LT(xi.tail<3>().maxCoeff(), 1e-6);
}

TEST_F(UnevenMotion, ASwingIsFoundWithItsSizeAlongItsAxis) {
  // Once to and fro in 0.1 s, 10 mm: mean square 50 mm², that of the means of eighths of a period 47.5 mm².
  const auto swing = [](double offset_s) {
    return Eigen::Vector3d(0, 0, 0.01 * std::sin(2.0 * test::kPi * offset_s / 0.1));
  };
  const Vector6d xi = of(test::twist(0, 0, 0, 0, 0, 0), SE3::Identity(), swing);
  EXPECT_NEAR(xi[5], 4.75e-5, 1e-5);
  EXPECT_LT(xi[3], 2e-6);
  EXPECT_LT(xi[4], 2e-6);
}

TEST_F(UnevenMotion, AxesAreThoseOfTheSensor) {
  const SE3 quarter_turn = se3_exp(test::twist(0, 0, 90.0 * test::kDegree, 0, 0, 0));
  const auto swing = [](double offset_s) {
    return Eigen::Vector3d(0.01 * std::sin(2.0 * test::kPi * offset_s / 0.1), 0, 0);
  };
  const Vector6d xi = of(test::twist(0, 0, 0, 0, 0, 0), quarter_turn, swing);
  EXPECT_NEAR(xi[3], 4.75e-5, 1e-5);
  EXPECT_LT(xi[4], 2e-6);
}

TEST_F(UnevenMotion, NothingIsSaidOfWhatSaysNothing) {
  IcpResult icp;
  const auto zero = [&](const TimedCloud& source, const LocalMap& map) {
    return uneven_motion(source, map, icp, kUnevenSigmaM, {}, kUnevenNoiseShare, 1) == Vector6d(Vector6d::Zero());
  };
  EXPECT_TRUE(zero({}, map_));
  EXPECT_TRUE(zero({{{6.13F, 0, 0}}, {}}, map_)) << "without times";
  EXPECT_TRUE(zero({{{6.13F, 0, 0}}, {0.01F}}, map_)) << "one instant";
  EXPECT_TRUE(zero({{{6.13F, 0, 0}, {6.12F, 0.2F, 0}}, {0.0F, 0.1F}}, LocalMap({}))) << "an empty map";
}

TEST_F(UnevenMotion, NoiseOfThePointsIsNoMotion) {
  TimedCloud source =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.11, 0.37, 1.3)), Vector6d::Zero());
  std::mt19937 rng(1);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (Eigen::Vector3f& p : source.points) {
    for (float& coordinate : p) {
      coordinate += noise(rng);
    }
  }
  EXPECT_EQ(uneven_motion(source, map_, {}, kUnevenSigmaM, {}, kUnevenNoiseShare, 1), Vector6d(Vector6d::Zero()));
}

TEST_F(UnevenMotion, WhatTheLeastNoiseExplainsIsNoMotion) {
  TimedCloud source =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.11, 0.37, 1.3)), Vector6d::Zero());
  for (std::size_t i = 0; i < source.size(); ++i) {
    source.points[i].z() += 0.01F * std::sin(62.8319F * source.offsets_s[i]);
  }
  // With one residual in five hundred counted, 2 cm of noise move a stretch by more than this swing.
  EXPECT_EQ(uneven_motion(source, map_, {}, kUnevenSigmaM, {}, 2e-3, 1)[5], 0.0);
  EXPECT_GT(uneven_motion(source, map_, {}, kUnevenSigmaM, {}, kUnevenNoiseShare, 1)[5], 4e-5);
}

// Each point of a sample stands for as many as there are: noise explains no more of it.
TEST_F(UnevenMotion, ASampleOfThePointsShowsTheSwingToo) {
  TimedCloud source =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.11, 0.37, 1.3)), Vector6d::Zero());
  for (std::size_t i = 0; i < source.size(); ++i) {
    source.points[i].z() += 0.01F * std::sin(62.8319F * source.offsets_s[i]);
  }
  const double all = uneven_motion(source, map_, {}, kUnevenSigmaM, {}, 1e-2, 1)[5];
  EXPECT_GT(all, 1e-5);
  EXPECT_NEAR(uneven_motion(source, map_, {}, kUnevenSigmaM, {}, 1e-2, 4)[5], all, 0.1 * all);
}

TEST_F(UnevenMotion, OfStretchesThatDoNotSeeADirectionNothingCounts) {
  TimedCloud all =
      test::measured_in_motion(test::seen_from(SE3::Identity(), test::rimless_room(0.11, 0.37, 1.3)), Vector6d::Zero());
  TimedCloud source;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.offsets_s[i] < 0.0F || std::abs(all.points[i].z()) < 2.8F) {  // later on neither floor nor ceiling
      source.points.push_back(all.points[i]);
      source.points.back().z() -= 0.01F * std::sin(62.8319F * all.offsets_s[i]);
      source.offsets_s.push_back(all.offsets_s[i]);
    }
  }
  EXPECT_NEAR(uneven_motion(source, map_, {}, kUnevenSigmaM, {}, kUnevenNoiseShare, 1)[5], 4.75e-5, 1e-5);
}

}  // namespace
}  // namespace rilo
