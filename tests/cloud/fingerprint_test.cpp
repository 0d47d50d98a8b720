// When a sweep is the one before again.
#include "cloud/fingerprint.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Firing by firing, with 16 beams; the first one returns nothing.
std::vector<Eigen::Vector3f> firings(float first, const Eigen::Vector3f& nothing) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 1600; ++i) {
    points.push_back(i % 16 == 0 ? nothing : Eigen::Vector3f(first + 0.01F * static_cast<float>(i), 1.0F, 2.0F));
  }
  return points;
}

TEST(Fingerprint, OnlyTheSameSweepIsEqual) {
  EXPECT_EQ(Fingerprint(firings(1, {0, 0, 0})), Fingerprint(firings(1, {0, 0, 0})));
  EXPECT_FALSE(Fingerprint(firings(1, {0, 0, 0})) == Fingerprint(firings(1.5, {0, 0, 0})));
}

TEST(Fingerprint, ABeamWithoutReturnsSaysNothing) {
  for (const Eigen::Vector3f& nothing : {Eigen::Vector3f(kNaN, kNaN, kNaN), Eigen::Vector3f(0, 0, 0)}) {
    EXPECT_FALSE(Fingerprint(firings(1, nothing)) == Fingerprint(firings(2, nothing)));
  }
}

TEST(Fingerprint, WithoutMeasurementsNoneIsEqual) {
  const std::vector<Eigen::Vector3f> nothing(100, Eigen::Vector3f::Constant(kNaN));
  EXPECT_FALSE(Fingerprint(nothing) == Fingerprint(nothing));
  EXPECT_FALSE(Fingerprint() == Fingerprint());
}

}  // namespace
}  // namespace rilo
