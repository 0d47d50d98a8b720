// Points whose times are not those of their sweep, and the middle of the sweeps.
#include <cmath>

#include <gtest/gtest.h>

#include "cloud/preprocess.hpp"

namespace rilo {
namespace {

constexpr std::size_t kPoints = 1000;

/// A revolution of `length_s`; the last `strays` points have the time `stray_s`.
Sweep revolution(float length_s, std::size_t strays = 0, float stray_s = 0.0F) {
  Sweep sweep;
  sweep.stamp_ns = 1'000'000'000;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(kPoints - 1);
    sweep.points.emplace_back(10.0F * std::cos(6.28F * share), 10.0F * std::sin(6.28F * share), share);
    sweep.times_s.push_back(i + strays < kPoints ? length_s * share : stray_s);
  }
  return sweep;
}

double middle_s(Preprocessor& preprocessor, const Sweep& sweep) {
  return static_cast<double>(preprocessor.prepare(sweep).mid_stamp_ns) * 1e-9 - 1.0;
}

TEST(StrayTimes, AreDroppedAndMoveNoMiddle) {
  for (const float stray_s : {2.0F, 0.3F, -0.2F}) {
    Preprocessor first{PreprocessConfig{}};
    EXPECT_NEAR(middle_s(first, revolution(0.1F, 10, stray_s)), 0.05, 1e-3);
    Preprocessor later{PreprocessConfig{}};
    EXPECT_NEAR(middle_s(later, revolution(0.1F)), 0.05, 1e-6);
    const PreparedSweep& spoilt = later.prepare(revolution(0.1F, 10, stray_s));
    EXPECT_EQ(spoilt.valid_points, kPoints - 10);
    for (const float offset_s : spoilt.map_cloud.offsets_s) {
      EXPECT_LE(std::abs(offset_s), 0.0501F);
    }
    EXPECT_NEAR(middle_s(later, revolution(0.1F)), 0.05, 1e-6);
  }
}

TEST(StrayTimes, AreTwoOfAHundredAtMost) {
  for (const std::size_t strays : {19U, 21U}) {
    Preprocessor preprocessor{PreprocessConfig{}};
    middle_s(preprocessor, revolution(0.1F));
    EXPECT_EQ(preprocessor.prepare(revolution(0.1F, strays, 0.3F)).valid_points,
              strays < 20 ? kPoints - strays : kPoints);
  }
}

TEST(StrayTimes, ManyOfThemAreALongerSweep) {
  Preprocessor preprocessor{PreprocessConfig{}};
  EXPECT_NEAR(middle_s(preprocessor, revolution(0.025F)), 0.0125, 1e-6);  // a part, as drivers begin
  EXPECT_NEAR(middle_s(preprocessor, revolution(0.1F)), 0.05, 1e-6);
  EXPECT_NEAR(middle_s(preprocessor, revolution(0.1F, 30, 0.2F)), 0.1, 1e-6);
}

TEST(StrayTimes, ASweepOfOneInstantHasNone) {
  Preprocessor preprocessor{PreprocessConfig{}};
  EXPECT_NEAR(middle_s(preprocessor, revolution(0.0F, 10, 0.1F)), 0.05, 1e-6);
}

}  // namespace
}  // namespace rilo
