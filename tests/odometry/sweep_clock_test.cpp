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

TEST(SweepClock, ExtremeStampsDoNotOverflow) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  SweepClock clock;
  for (const std::int64_t stamp : {kMost, kLeast, kMost, std::int64_t{0}, kLeast, kMost}) {
    const SweepTime time = clock.advance(stamp);
    EXPECT_GE(time.step_ns, 0);
    EXPECT_LE(time.step_ns, 10'000 * kMs);
  }
}

}  // namespace
}  // namespace rilo
