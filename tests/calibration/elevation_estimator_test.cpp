// The estimate of the sensor's elevation error over the sweeps: by hand, and when it is applied.
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/elevation_offset.hpp"
#include "geometry/degrees.hpp"

namespace rilo {
namespace {

constexpr double kUsualRad = 0.2 * kRadPerDeg;  // what sensors usually have, before the sweeps say anything

/// Standard deviation of what the sweeps alone say.
double own_sigma_rad(const ElevationOffsetEstimator& estimator) {
  return 1.0 / std::sqrt(std::pow(estimator.estimate().sigma_rad, -2) - std::pow(kUsualRad, -2));
}

TEST(ElevationEstimator, TheEstimatorFindsWhatASteadyResponsePointsAt) {
  ElevationOffsetEstimator estimator({});
  const double truth = 0.2 * kRadPerDeg;
  for (int i = 0; i < 100; ++i) {
    ElevationInformation sweep;
    sweep.information = 1e9;
    sweep.jacobian_m = 5.0;
    sweep.gradient = 0.6 * sweep.information * (truth - estimator.applied_rad());  // weakened by noise
    estimator.add(sweep);
    const double before = estimator.applied_rad();
    const double change = estimator.advance();
    EXPECT_NEAR(estimator.applied_rad(), before + change, 1e-15);
    if (estimator.applied_rad() != 0.0) {
      EXPECT_NEAR(estimator.applied_rad(), estimator.estimate().rad, 1e-15) << "the whole of it at once";
    }
  }
  EXPECT_NEAR(estimator.applied_rad(), truth, 0.01 * kRadPerDeg);
}

// Sweeps whose residuals point at `truth`.
void see(ElevationOffsetEstimator& estimator, double truth_rad, int sweeps, double information = 1e9) {
  for (int i = 0; i < sweeps; ++i) {
    ElevationInformation sweep;
    sweep.information = information;
    sweep.jacobian_m = 5.0;
    sweep.gradient = 0.5 * sweep.information * (truth_rad - estimator.applied_rad());
    estimator.add(sweep);
    estimator.advance();
  }
}

TEST(ElevationEstimator, WhatIsKnownBeforehandIsAppliedAtOnceAndFollowed) {
  ElevationOffsetConfig config;
  config.initial_deg = 0.27;  // an early find that was too much: it is 0.21
  ElevationOffsetEstimator estimator(config);
  EXPECT_DOUBLE_EQ(estimator.applied_rad(), 0.27 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(estimator.estimate().rad, 0.27 * kRadPerDeg);
  see(estimator, 0.21 * kRadPerDeg, 60);
  EXPECT_NEAR(estimator.applied_rad(), 0.21 * kRadPerDeg, 1e-3 * kRadPerDeg);
  config.enabled = false;  // nothing is estimated; what is known counts all the same
  EXPECT_DOUBLE_EQ(ElevationOffsetEstimator(config).applied_rad(), 0.27 * kRadPerDeg);
  config.enabled = true;
  config.significance = 1000;
  ElevationOffsetEstimator fixed(config);
  see(fixed, 0.21 * kRadPerDeg, 60);
  EXPECT_DOUBLE_EQ(fixed.applied_rad(), 0.27 * kRadPerDeg);
}

TEST(ElevationEstimator, AnotherRunBeginsWithAnEstimateThatWasCertain) {
  ElevationOffsetEstimator estimator({});
  see(estimator, 0.2 * kRadPerDeg, 60);
  const double found = estimator.estimate().rad;
  EXPECT_NEAR(estimator.known_deg(), found / kRadPerDeg, 1e-9);
  estimator.begin_with(estimator.known_deg(), {});
  EXPECT_NEAR(estimator.applied_rad(), found, 1e-12);
  EXPECT_EQ(estimator.estimate().rad, estimator.applied_rad());
  EXPECT_TRUE(std::isinf(estimator.estimate().sigma_rad)) << "the same sweeps come again: they must not count twice";
  see(estimator, 0.1 * kRadPerDeg, 60);
  EXPECT_NEAR(estimator.applied_rad(), 0.1 * kRadPerDeg, 1e-3 * kRadPerDeg);

  ElevationOffsetConfig config;
  config.initial_deg = 0.1;
  ElevationOffsetEstimator few(config);
  see(few, 0.4 * kRadPerDeg, 3);  // of which nothing is certain
  few.begin_with(few.known_deg(), {});
  EXPECT_DOUBLE_EQ(few.applied_rad(), 0.1 * kRadPerDeg);
}

TEST(ElevationEstimator, WhatOtherRecordingsSayCountsByItsInformation) {
  const AngleEstimate others{0.08 * kRadPerDeg, 0.05 * kRadPerDeg};
  ElevationOffsetEstimator estimator({});
  estimator.begin_with(0.0, others);
  EXPECT_EQ(estimator.estimate().rad, others.rad);
  EXPECT_EQ(estimator.estimate().sigma_rad, others.sigma_rad);
  EXPECT_EQ(estimator.advance(), 0.0) << "1.6 standard deviations are not certain";
  ElevationOffsetEstimator alone({});
  see(alone, 0.09 * kRadPerDeg, 60);
  see(estimator, 0.09 * kRadPerDeg, 60);
  const double own_weight = std::pow(own_sigma_rad(alone), -2);
  const double weight = std::pow(others.sigma_rad, -2);
  EXPECT_NEAR(estimator.estimate().sigma_rad, 1 / std::sqrt(own_weight + weight), 1e-9);
  EXPECT_NEAR(estimator.estimate().rad, (own_weight * 0.09 * kRadPerDeg + weight * others.rad) / (own_weight + weight),
              1e-4 * kRadPerDeg);
  estimator.begin_with(estimator.known_deg(), estimator.others());
  EXPECT_EQ(estimator.estimate().rad, others.rad) << "the same sweeps come again: they must not count twice";
}

TEST(ElevationEstimator, OtherRecordingsThatContradictDoNotCount) {
  ElevationOffsetEstimator estimator({});
  estimator.begin_with(0.3, {0.3 * kRadPerDeg, 0.001 * kRadPerDeg});
  see(estimator, -0.1 * kRadPerDeg, 60);
  EXPECT_EQ(estimator.others().rad, 0.0);
  EXPECT_EQ(estimator.others().sigma_rad, kUsualRad) << "as if nothing were known";
  EXPECT_NEAR(estimator.estimate().rad, -0.1 * kRadPerDeg, 1e-3 * kRadPerDeg);
  EXPECT_NEAR(estimator.applied_rad(), -0.1 * kRadPerDeg, 1e-3 * kRadPerDeg);
}

TEST(ElevationEstimator, ACorrectionIsTakenBackWhereTheSweepsSayThatThereIsNone) {
  ElevationOffsetEstimator estimator({});
  see(estimator, 0.2 * kRadPerDeg, 30);
  EXPECT_NEAR(estimator.applied_rad(), 0.2 * kRadPerDeg, 1e-3 * kRadPerDeg);
  see(estimator, 0.0, 300);
  EXPECT_NEAR(estimator.applied_rad(), 0.0, 1e-3 * kRadPerDeg);
}

TEST(ElevationEstimator, AnErrorIsAppliedWhereItIsSignificant) {
  for (const double share : {0.95, 1.05}) {
    ElevationOffsetEstimator known({});
    const double sigma = 0.05 * kRadPerDeg;
    known.begin_with(0.0, {2.3 * share * sigma, sigma});
    EXPECT_EQ(known.advance(), share < 1 ? 0.0 : known.estimate().rad);
  }
}

TEST(ElevationEstimator, AnErrorThatIsNoLongerSignificantIsTakenBack) {
  ElevationOffsetEstimator estimator({});
  see(estimator, 0.2 * kRadPerDeg, 15);
  ASSERT_GT(estimator.applied_rad(), 0.0);
  const double block_rad = 4.0 * kRadPerDeg;
  for (int block = 0; block < 20 && estimator.applied_rad() != 0.0; ++block) {
    see(estimator, block % 2 == 0 ? -block_rad : block_rad, 5);  // what each block sees contradicts the last
    const AngleEstimate now = estimator.estimate();
    EXPECT_EQ(estimator.applied_rad(), std::abs(now.rad) > 2.001 * now.sigma_rad ? now.rad : 0.0);
  }
  EXPECT_EQ(estimator.applied_rad(), 0.0);
  EXPECT_EQ(estimator.known_deg(), 0.0) << "nor does another run begin with it";
}

TEST(ElevationEstimator, AnErrorThatIsJustSignificantDoesNotComeAndGo) {
  const double sigma = 0.05 * kRadPerDeg;
  ElevationOffsetEstimator known({});
  known.begin_with(0.0, {2.35 * sigma, sigma});
  known.advance();
  ASSERT_GT(known.applied_rad(), 0.0);
  // Sweeps that hardly count beside it move it below the bound.
  int between = 0;
  for (int i = 0; i < 200; ++i) {
    see(known, 0.0, 1, 0.01 / (sigma * sigma));
    const AngleEstimate now = known.estimate();
    const double ratio = now.rad / now.sigma_rad;
    EXPECT_EQ(known.applied_rad() != 0.0, ratio > 0.87 * 2.3) << ratio;
    between += ratio < 2.3 && ratio > 0.87 * 2.3 ? 1 : 0;
  }
  EXPECT_GT(between, 0);
  EXPECT_EQ(known.applied_rad(), 0.0);
}

TEST(ElevationEstimator, WhatIsKnownBeforehandIsCorrectedWhenItIsWrong) {
  ElevationOffsetConfig config;
  config.initial_deg = 0.3;
  ElevationOffsetEstimator estimator(config);
  see(estimator, 0.0, 60);
  EXPECT_NEAR(estimator.applied_rad(), 0.0, 2e-3 * kRadPerDeg);
}

/// Sweeps that know the angle to `1 / sqrt(1e9)` rad and see `offset_rad` from the angle that is applied.
void add(ElevationOffsetEstimator& estimator, double offset_rad, int sweeps) {
  for (int i = 0; i < sweeps; ++i) {
    ElevationInformation sweep;
    sweep.information = 1e9;
    sweep.jacobian_m = 5.0;
    sweep.gradient = 0.5 * sweep.information * offset_rad;
    estimator.add(sweep);
  }
}

TEST(ElevationEstimator, ResidualsAnswerToHalfOfAnErrorAndTheLastSweepsCountMost) {
  ElevationOffsetEstimator estimator({});
  add(estimator, 0.001, 1);
  EXPECT_NEAR(estimator.estimate().rad, 0.001, 1e-12);
  add(estimator, 0.004, 1);  // the one before keeps a quarter
  EXPECT_NEAR(estimator.estimate().rad, (0.25 * 0.001 + 0.004) / 1.25, 1e-12);
  add(estimator, 0.0, 1);  // 1/9, 4/9
  EXPECT_NEAR(estimator.estimate().rad, (0.001 + 4.0 * 0.004) / 14.0, 1e-12);
}

TEST(ElevationEstimator, WhereAllSweepsAgreeTheErrorOfSurfacesIsLeft) {
  ElevationOffsetEstimator estimator({});
  add(estimator, 0.001, 14);
  EXPECT_TRUE(std::isinf(estimator.estimate().sigma_rad)) << "two blocks of five";
  add(estimator, 0.001, 1);
  const double information = 1e9 * 1240.0 / 225.0;  // Σ i² / 15²
  EXPECT_NEAR(own_sigma_rad(estimator), std::sqrt(1.0 / information + std::pow(0.001 / 5.0, 2)), 1e-9);
}

TEST(ElevationEstimator, WhereBlocksDisagreeTheirScatterCounts) {
  constexpr double kOff = 0.01;
  ElevationOffsetEstimator estimator({});
  double total = 0.0;
  double squares = 0.0;
  double mean = 0.0;
  for (int block = 0; block < 6; ++block) {
    const double offset = block % 2 == 0 ? kOff : -kOff;
    add(estimator, offset, 5);
    double weight = 0.0;
    for (int i = 5 * block + 1; i <= 5 * block + 5; ++i) {
      weight += i * i;
    }
    total += weight;
    squares += weight * weight;
    mean += weight * offset;
  }
  mean /= total;
  const double blocks = total * total / squares;  // as many of equal weight
  const double expected = (kOff * kOff - mean * mean) / (blocks - 1.0) + std::pow(0.001 / 5.0, 2);
  EXPECT_NEAR(own_sigma_rad(estimator), std::sqrt(expected), 1e-6 * kOff);
}

// A few beams that decide alone may all be off; many even out.
TEST(ElevationEstimator, TheFewerBeamsDecideTheMoreTheirErrorsCount) {
  for (const std::size_t bands : {1U, 4U, 100U}) {
    ElevationOffsetEstimator estimator({});
    for (int i = 0; i < 15; ++i) {
      ElevationInformation sweep;
      sweep.information = 1e9;
      sweep.jacobian_m = 1e9;  // no error of surfaces
      for (std::size_t band = 0; band < bands; ++band) {
        sweep.by_band[band + 40] = sweep.information / static_cast<double>(bands);
      }
      estimator.add(sweep);
    }
    const double information = 1e9 * 1240.0 / 225.0;  // Σ i² / 15²
    const double beams = std::pow(0.05 * kRadPerDeg, 2) / static_cast<double>(bands);
    EXPECT_NEAR(own_sigma_rad(estimator), std::sqrt(1.0 / information + beams), 1e-9) << bands << " bands";
  }
}

TEST(ElevationEstimator, WhatTheSweepsSayIsSeenBesideWhatIsUsual) {
  constexpr double kOff = 0.004;
  ElevationOffsetConfig config;
  config.initial_deg = 0.1;  // what is configured is the usual of this sensor
  ElevationOffsetEstimator estimator(config);
  const double initial = 0.1 * kRadPerDeg;
  for (int block = 0; block < 6; ++block) {
    add(estimator, block % 2 == 0 ? 2.0 * kOff : 0.0, 5);
  }
  const double sigma = own_sigma_rad(estimator);
  EXPECT_GT(sigma, 0.2 * kUsualRad);
  const double share = kUsualRad * kUsualRad / (kUsualRad * kUsualRad + sigma * sigma);
  double total = 0.0;
  double mean = 0.0;
  for (int i = 1; i <= 30; ++i) {
    total += i * i;
    mean += i * i * ((i - 1) / 5 % 2 == 0 ? 2.0 * kOff : 0.0);
  }
  EXPECT_NEAR(estimator.estimate().rad, initial + share * mean / total, 1e-9);
}

TEST(ElevationEstimator, ABlockThatIsNotFullDoesNotScatter) {
  ElevationOffsetEstimator estimator({});
  add(estimator, 0.01, 15);
  add(estimator, 0.05, 2);
  const double information = 1e9 * 1785.0 / 289.0;  // Σ i² / 17²
  EXPECT_NEAR(own_sigma_rad(estimator), std::sqrt(1.0 / information + std::pow(0.001 / 5.0, 2)), 1e-8);
}

}  // namespace
}  // namespace rilo
