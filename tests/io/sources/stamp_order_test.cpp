#include <cmath>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/sweeps_source.hpp"

namespace rilo::test {
namespace {

// A recording of sweeps in the given order; the second number is when each was received.
std::unique_ptr<ScanSource> recording(const TempDir& folder, const std::vector<Sweep>& sweeps,
                                      const std::vector<std::size_t>& order,
                                      const std::vector<std::int64_t>& late = {}) {
  auto all = recorded(sweeps, MessageEncoding::kCdr);
  std::vector<Recorded> messages;
  for (std::size_t i = 0; i < order.size(); ++i) {
    messages.push_back(all[order[i]]);
    if (!late.empty()) messages.back().received_ns += late[i];
  }
  return open_scan_source(folder.write("r.mcap", mcap_bytes({{"/points", kRos2Type}}, messages, {})));
}

std::vector<float> marks(ScanSource& source) {
  std::vector<float> all;
  while (const auto sweep = source.next()) all.push_back(std::floor(sweep->points[0].x()));
  return all;
}

TEST(StampOrderTest, GapsAreCounted) {
  const TempDir folder;
  const auto source = recording(folder, numbered_sweeps(20), {0, 1, 2, 3, 6, 7, 8, 12, 13});
  EXPECT_EQ(marks(*source).size(), 9U);
  const StampFaults faults = source->info().faults;
  EXPECT_EQ(faults.gaps, 2U);
  EXPECT_EQ(faults.missing, 5U);
  EXPECT_NEAR(faults.longest_gap_s, 0.4, 1e-9);
  EXPECT_TRUE(has_warning(source->info(), "a gap of 0.300 s before it (2 missing)"));
}

// Sweeps with stamps in ms, every 100 ms if all is well; each has points of its own.
std::unique_ptr<ScanSource> stamped(const std::vector<std::int64_t>& stamps_ms) {
  std::vector<Sweep> sweeps(stamps_ms.size());
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    sweeps[i].stamp_ns = stamps_ms[i] * 1'000'000;
    sweeps[i].points = {{static_cast<float>(i), 1, 1}};
  }
  return detail::with_stamp_order(std::make_unique<SweepsSource>(std::move(sweeps)));
}

TEST(StampOrderTest, FromOneAndAHalfPeriodsOnIsAGap) {
  const auto source = stamped({0, 149, 300, 700, 1000});
  EXPECT_EQ(marks(*source).size(), 5U);
  EXPECT_EQ(source->info().faults.gaps, 3U);
  EXPECT_EQ(source->info().faults.missing, 1U + 3U + 2U);
  EXPECT_NEAR(source->info().faults.longest_gap_s, 0.4, 1e-9);
}

TEST(StampOrderTest, WhatIsSkippedIsNoGapWhatIsMissingLaterIs) {
  const auto source = stamped({0, 100, 200, 300, 600, 700});
  EXPECT_TRUE(source->next());
  EXPECT_EQ(source->skip(2), 2U);
  EXPECT_TRUE(source->next());
  EXPECT_EQ(source->info().faults.gaps, 0U);
  EXPECT_EQ(source->skip(0), 0U);
  EXPECT_TRUE(source->next());
  EXPECT_EQ(source->info().faults.gaps, 1U);
}

// Five late ones at most in a row, and none by more than a second.
TEST(StampOrderTest, LateOnesBetweenOthersAreNoClockThatWasSet) {
  const auto late = stamped({5000, 4000, 4700, 4800, 5100, 4200, 4900, 4950, 5200, 5300});
  EXPECT_EQ(marks(*late), (std::vector<float>{0, 4, 8, 9}));
  EXPECT_EQ(late->info().faults.clock_jumps, 0U);
  EXPECT_EQ(late->info().faults.out_of_order, 6U);
  const auto set = stamped({5000, 3999, 4100});
  EXPECT_EQ(marks(*set).size(), 3U);
  EXPECT_EQ(set->info().faults.clock_jumps, 1U);
}

TEST(StampOrderTest, DuplicatesAndOldSweepsAreLeftOut) {
  const TempDir folder;
  const auto source = recording(folder, numbered_sweeps(8), {0, 1, 1, 3, 2, 4, 5, 5, 5, 6});
  EXPECT_EQ(marks(*source), (std::vector<float>{0, 1, 3, 4, 5, 6}));
  const StampFaults faults = source->info().faults;
  EXPECT_EQ(faults.duplicates, 3U);
  EXPECT_EQ(faults.out_of_order, 1U);
  EXPECT_EQ(faults.gaps, 1U);
  EXPECT_TRUE(has_warning(source->info(), "dropped: 0.100 s older"));
}

TEST(StampOrderTest, AClockThatIsSetBackDoesNotStopTheRun) {
  const TempDir folder;
  auto sweeps = numbered_sweeps(30);
  for (std::size_t i = 10; i < 20; ++i) sweeps[i].stamp_ns -= 3'600'000'000'000;  // an hour
  for (std::size_t i = 20; i < 30; ++i) sweeps[i].stamp_ns -= 3'600'800'000'000;  // and another 0.8 s
  std::vector<std::size_t> order(30);
  for (std::size_t i = 0; i < 30; ++i) order[i] = i;
  const auto source = recording(folder, sweeps, order);
  const auto all = marks(*source);
  EXPECT_EQ(all.size(), 25U);  // five of the small jump were held for late ones
  EXPECT_EQ(source->info().faults.clock_jumps, 2U);
  EXPECT_EQ(source->info().faults.out_of_order, 5U);
  EXPECT_EQ(all.back(), 29);
}

TEST(StampOrderTest, ARepeatedStampWithOtherPointsIsKept) {
  const TempDir folder;
  auto sweeps = numbered_sweeps(4);
  sweeps[2].stamp_ns = sweeps[1].stamp_ns;
  const auto source = recording(folder, sweeps, {0, 1, 2, 3});
  EXPECT_EQ(marks(*source).size(), 4U);
  EXPECT_EQ(source->info().faults.repeated, 1U);
  EXPECT_EQ(source->info().faults.duplicates, 0U);
}

TEST(StampOrderTest, LateSweepsAreCounted) {
  const TempDir folder;
  const auto source = recording(folder, numbered_sweeps(5), {0, 1, 2, 3, 4}, {0, 0, 250'000'000, 90'000'000, 0});
  EXPECT_EQ(marks(*source).size(), 5U);
  EXPECT_EQ(source->info().faults.late, 1U);
  EXPECT_NEAR(source->info().faults.most_late_s, 0.25, 1e-9);
}

TEST(StampOrderTest, WarningsHaveAnEnd) {
  const TempDir folder;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < 60; ++i) order.push_back(i / 2);
  const auto source = recording(folder, numbered_sweeps(30), order);
  EXPECT_EQ(marks(*source).size(), 30U);
  EXPECT_EQ(source->info().faults.duplicates, 30U);
  EXPECT_LE(source->info().warnings.size(), 21U);
}

}  // namespace
}  // namespace rilo::test
