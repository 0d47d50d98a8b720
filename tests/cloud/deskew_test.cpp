// Motion compensation against the exponential of every single point.
#include "cloud/deskew.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;  // rad/s at 360 °/s

TimedCloud sphere(std::size_t count, float range_m, float begin_s, float end_s) {
  std::mt19937 rng(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> time(begin_s, end_s);
  TimedCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(range_m * Eigen::Vector3f(normal(rng), normal(rng), normal(rng)).normalized());
    cloud.offsets_s.push_back(time(rng));
  }
  return cloud;
}

double worst_error_m(const TimedCloud& cloud, const BodyMotion& motion) {
  std::vector<Eigen::Vector3f> out;
  deskew(cloud, motion, out);
  EXPECT_EQ(out.size(), cloud.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto s = static_cast<double>(cloud.offsets_s[i]);
    const SE3 T = se3_exp(s * motion.twist + 0.5 * s * s * motion.acceleration);
    worst = std::max(worst, (T * cloud.points[i].cast<double>() - out[i].cast<double>()).norm());
  }
  return worst;
}

TEST(DeskewTest, FastMotionIsWithinAThirdOfAMillimetre) {
  const TimedCloud cloud = sphere(20000, 100.0F, -0.05F, 0.05F);
  std::mt19937 rng(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10; ++i) {
    Vector6d twist;
    twist << kTurn * Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized(),
        30.0 * Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
    EXPECT_LT(worst_error_m(cloud, {twist}), 3.3e-4);
  }
}

TEST(DeskewTest, AnArmThatJerksTheSensorIsWithinAQuarterOfAMillimetre) {
  const TimedCloud cloud = sphere(20000, 30.0F, -0.05F, 0.05F);
  BodyMotion motion;
  motion.twist << 1.0, -2.0, 0.5, 1.0, -0.5, 0.3;
  motion.acceleration << 20.0, -40.0, 20.0, 30.0, 10.0, -20.0;
  EXPECT_LT(worst_error_m(cloud, motion), 2.5e-4);
}

TEST(DeskewTest, TurnOnTheSpotAndStraightDrive) {
  const TimedCloud cloud = sphere(5000, 100.0F, 0.0F, 0.1F);
  Vector6d turn = Vector6d::Zero();
  turn[2] = kTurn;
  EXPECT_LT(worst_error_m(cloud, {turn}), 3.3e-4);
  Vector6d drive = Vector6d::Zero();
  drive[3] = 30.0;
  EXPECT_LT(worst_error_m(cloud, {drive}), 3e-5);
}

TEST(DeskewTest, ReferenceInstantStaysWhereItIs) {
  Vector6d twist;
  twist << 0.0, 0.0, 1.0, 10.0, 0.0, 0.0;
  const TimedCloud cloud{{{5.0F, 0.0F, 0.0F}, {5.0F, 0.0F, 0.0F}, {5.0F, 0.0F, 0.0F}}, {-0.05F, 0.0F, 0.05F}};
  std::vector<Eigen::Vector3f> out;
  deskew(cloud, {twist}, out);
  EXPECT_LT((out[1] - cloud.points[1]).norm(), 1e-6F);
  // Seen from the later place, half a metre ahead, the same reading is that much farther.
  EXPECT_NEAR(out[2].x(), 5.5F, 0.01F);
  EXPECT_NEAR(out[0].x(), 4.5F, 0.01F);
}

TEST(DeskewTest, AlongOtherAxesAboutTheSensor) {
  const TimedCloud cloud = sphere(500, 50.0F, -0.05F, 0.05F);
  const BodyMotion motion{(Vector6d() << 0.1, -0.2, 1.0, 10.0, 1.0, 0.0).finished()};
  const Eigen::Matrix3d R = so3_exp({0.3, -1.0, 2.0});
  const SweepMotion along_own = SweepMotion::during(cloud, motion);
  const SweepMotion along_others(motion, span_of(cloud), R);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f expected = R.cast<float>() * along_own.compensated(cloud, i);
    EXPECT_LT((along_others.compensated(cloud, i) - expected).norm(), 2e-5F);
  }
}

TEST(DeskewTest, UntimedCloudIsCopied) {
  TimedCloud cloud = sphere(100, 10.0F, 0.0F, 0.1F);
  cloud.offsets_s.clear();
  std::vector<Eigen::Vector3f> out(7);
  deskew(cloud, {Vector6d::Ones()}, out);
  EXPECT_EQ(out, cloud.points);
  const Eigen::Matrix3d R = so3_exp({0.3, -1.0, 2.0});
  const SweepMotion motion({Vector6d::Ones()}, span_of(cloud), R);
  EXPECT_LT((motion.compensated(cloud, 3) - R.cast<float>() * cloud.points[3]).norm(), 1e-5F);
}

TEST(DeskewTest, EmptyCloud) {
  std::vector<Eigen::Vector3f> out(3);
  deskew(TimedCloud{}, {Vector6d::Ones()}, out);
  EXPECT_TRUE(out.empty());
}

TEST(DeskewTest, OneInstantForAllPoints) {
  TimedCloud cloud = sphere(100, 50.0F, 0.0F, 0.1F);
  cloud.offsets_s.assign(cloud.size(), 0.07F);
  EXPECT_LT(worst_error_m(cloud, {Vector6d::Ones()}), 3e-5);
}

TEST(DeskewTest, TheSpanIsThatOfAllInstantsWhereverTheEndsLie) {
  const BodyMotion motion{(Vector6d() << 0.0, 0.0, 3.0, 10.0, 0.0, 0.0).finished()};
  for (const std::size_t count : {1U, 15U, 16U, 37U, 64U}) {
    for (std::size_t k = 0; k < count; ++k) {
      TimedCloud cloud;
      cloud.points.assign(count, Eigen::Vector3f(20.0F, 3.0F, 1.0F));
      cloud.offsets_s.assign(count, 0.01F);
      cloud.offsets_s[k] = -0.05F;
      cloud.offsets_s[(k + 5) % count] = 0.04F;
      const auto [begin, end] = std::minmax_element(cloud.offsets_s.begin(), cloud.offsets_s.end());
      const SweepMotion expected(motion, {*begin, *end});
      const SweepMotion during = SweepMotion::during(cloud, motion);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(during.compensated(cloud, i), expected.compensated(cloud, i)) << count << ' ' << k;
      }
    }
  }
}

TEST(DeskewTest, InstantsOutsideTheTableUseItsEnds) {
  Vector6d twist;
  twist << 0.0, 0.0, 0.5, 10.0, 0.0, 0.0;
  const SweepMotion motion({twist}, {-0.05F, 0.05F});
  const Eigen::Vector3f p(20.0F, 3.0F, 1.0F);
  for (const float offset : {-0.06F, 0.06F}) {
    const SE3 T = se3_exp(twist * static_cast<double>(offset));
    EXPECT_LT((T * p.cast<double>() - motion.compensate(p, offset).cast<double>()).norm(), 1e-3);
  }
}

}  // namespace
}  // namespace rilo
