// The odometry's own time against stamps that are wrong.
#include "odometry/sweep_clock.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::vector<std::int64_t> steps_ms(SweepClock& clock, const std::vector<std::int64_t>& stamps_ms) {
  std::vector<std::int64_t> steps;
  for (const std::int64_t stamp : stamps_ms) {
    steps.push_back(clock.advance(stamp * kMs).step_ns / kMs);
  }
  return steps;
}

TEST(SweepClock, TakesBelievableStepsAsTheyAre) {
  SweepClock clock;
  EXPECT_EQ(steps_ms(clock, {500, 600, 710, 800, 1900}), (std::vector<std::int64_t>{0, 100, 110, 90, 1100}));
  EXPECT_EQ(clock.period_ns(), 110 * kMs);  // of 90, 100, 110, 1100
}

TEST(SweepClock, OneStampAheadIsForgotten) {
  SweepClock clock;
  EXPECT_EQ(steps_ms(clock, {0, 100, 200, 1'000'300, 400, 500}),
            (std::vector<std::int64_t>{0, 100, 100, 100, 100, 100}));
  EXPECT_EQ(clock.advance(600 * kMs).stamp_ns, 600 * kMs);
}

TEST(SweepClock, AClockThatWasSetForwardIsFollowed) {
  SweepClock clock;
  EXPECT_EQ(steps_ms(clock, {0, 100, 100'200, 100'300, 100'400}), (std::vector<std::int64_t>{0, 100, 100, 100, 100}));
  EXPECT_EQ(clock.advance(100'500 * kMs).stamp_ns, 100'500 * kMs);
}

TEST(SweepClock, AClockThatWasSetBackKeepsStampsIncreasing) {
  SweepClock clock;
  steps_ms(clock, {50'000, 50'100, 50'200});
  std::int64_t last = 50'200 * kMs;
  for (const std::int64_t stamp : {300, 410, 500}) {
    const SweepTime time = clock.advance(stamp * kMs);
    EXPECT_GT(time.stamp_ns, last);
    last = time.stamp_ns;
  }
  EXPECT_EQ(last, 50'500 * kMs);  // a period for the jump, then 110 and 90 ms
}

std::vector<std::int64_t> even_ms(SweepClock& clock, const std::vector<std::int64_t>& stamps_ms) {
  std::vector<std::int64_t> steps;
  for (const std::int64_t stamp : stamps_ms) {
    steps.push_back((clock.advance(stamp * kMs).even_ns + kMs / 2) / kMs);
  }
  return steps;
}

TEST(SweepClock, EvenStampsAreThoseOfAnEvenClock) {
  SweepClock clock;
  EXPECT_EQ(even_ms(clock, {0, 100, 200, 500, 600, 800}), (std::vector<std::int64_t>{0, 100, 100, 300, 100, 200}));
}

TEST(SweepClock, AnEvenClockTicksOnUnderLateStamps) {
  SweepClock clock;
  std::vector<std::int64_t> stamps;
  for (std::int64_t i = 0; i < 60; ++i) {
    stamps.push_back(100 * i + (7 * i) % 13);  // 0 to 12 ms late
  }
  for (const std::int64_t late : {40, 20, 0}) {
    stamps.push_back(100 * static_cast<std::int64_t>(stamps.size()) + late);
  }
  const std::vector<std::int64_t> even = even_ms(clock, stamps);
  for (std::size_t i = 20; i < 60; ++i) {
    EXPECT_NEAR(static_cast<double>(even[i]), 100.0, 1.0) << i;
  }
  for (std::size_t i = 60; i < even.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(even[i]), 100.0, 3.0) << i;  // steps of 140, 80 and 80 ms
  }
}

// A stamp 40 ms late, of which half counts; the one that is 85 ms late then is that of the next tick but one.
TEST(SweepClock, WhatAStampWasLateIsCarriedOn) {
  SweepClock clock;
  steps_ms(clock, {0, 100, 200, 300, 400, 500, 600, 700, 800, 940});
  // Eleven ticks in 1085 ms, two of them in the last step.
  EXPECT_NEAR(static_cast<double>(clock.advance(1085 * kMs).even_ns), 2.0 / 11.0 * 1085.0 * kMs, 2.0);
}

TEST(SweepClock, PairsOfStampsAreSweepsInARow) {
  SweepClock clock;
  std::vector<std::int64_t> stamps;
  for (std::int64_t i = 0; i < 64; ++i) {
    stamps.push_back(100 * i + (i % 2 == 0 ? 90 : 0));  // 10 and 190 ms apart
  }
  const std::vector<std::int64_t> even = even_ms(clock, stamps);
  for (std::size_t i = 40; i < even.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(even[i]), 100.0, 5.0) << i;
  }
}

TEST(SweepClock, AnotherPeriodIsFollowed) {
  SweepClock clock;
  std::vector<std::int64_t> stamps = {0};
  for (std::int64_t i = 1; i < 100; ++i) {
    stamps.push_back(stamps.back() + (i < 40 ? 100 : 50));
  }
  EXPECT_EQ(even_ms(clock, stamps).back(), 50);
}

// Later points are seen for the first time: the middle of the sweeps moves, the sensor spins evenly.
TEST(SweepClock, AMiddleThatMovesIsNoDeviation) {
  SweepClock clock;
  const std::int64_t middles_us[] = {12'000, 49'000, 49'991, 49'991, 49'994, 49'999, 50'000};
  for (std::int64_t i = 0; i < 7; ++i) {
    const std::int64_t to_middle_ns = 1000 * middles_us[i];
    const SweepTime time = clock.advance(100 * i * kMs + to_middle_ns, to_middle_ns);
    EXPECT_EQ(time.stamp_ns, 100 * i * kMs + to_middle_ns);
    EXPECT_EQ(time.step_ns, i == 0 ? 0 : 100 * kMs + 1000 * (middles_us[i] - middles_us[i - 1]));
    EXPECT_EQ(time.even_ns, time.step_ns);
  }
}

TEST(SweepClock, ExtremeStampsDoNotOverflow) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  SweepClock clock;
  for (const std::int64_t stamp : {kMost, kLeast, kMost, std::int64_t{0}, kLeast, kMost}) {
    const SweepTime time = clock.advance(stamp);
    EXPECT_GE(time.step_ns, 0);
    EXPECT_LE(time.step_ns, 10'000 * kMs);
    EXPECT_GE(time.even_ns, 0);
    EXPECT_LE(time.even_ns, 320'000 * kMs);
  }
}

// Stamps that stand still, points whose times go on: the middle moves by all that the stamps should.
TEST(SweepClock, TimesOfPointsThatGoOnInPlaceOfStamps) {
  SweepClock clock;
  for (std::int64_t i = 0; i < 6; ++i) {
    const SweepTime time = clock.advance(50 * i * kMs, 50 * i * kMs);
    EXPECT_EQ(time.step_ns, i == 0 ? 0 : 50 * kMs);
    EXPECT_EQ(clock.period_ns(), 100 * kMs);  // nothing is known of it
  }
  const SweepTime later = clock.advance(9250 * kMs, 250 * kMs);
  EXPECT_EQ(later.step_ns, 9000 * kMs);
  EXPECT_EQ(later.even_ns, 9000 * kMs);
}

TEST(SweepClock, AfterAStampInDoubtStepsCountAsTheyAre) {
  SweepClock clock;
  EXPECT_EQ(steps_ms(clock, {0, 100, 200, 1'000'300, 400, 520, 610}),
            (std::vector<std::int64_t>{0, 100, 100, 100, 100, 120, 90}));
}

TEST(SweepClock, NoSensorSpinsInHalfAMillisecond) {
  SweepClock clock;
  steps_ms(clock, {0, 100, 200});
  const SweepTime time = clock.advance(200 * kMs + kMs / 2);
  EXPECT_EQ(time.step_ns, 100 * kMs);
}

}  // namespace
}  // namespace rilo
