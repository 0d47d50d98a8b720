// Level and sentence of the diagnostics.
#include "node/node_health.hpp"

#include <algorithm>

#include <gmock/gmock.h>

namespace rilo {
namespace {

using testing::HasSubstr;

std::string figure(const StatusMessage& status, const std::string& key) {
  const auto found =
      std::find_if(status.values.begin(), status.values.end(), [&](const auto& pair) { return pair.first == key; });
  return found == status.values.end() ? "none" : found->second;
}

SweepResult with_status(OdometryStatus status, double ms) {
  SweepResult result;
  result.status = status;
  result.stats.times.total_ms = ms;
  return result;
}

TEST(NodeHealth, BeginsWithWhatItWaitsFor) {
  NodeHealth health;
  EXPECT_EQ(health.report({}).message, "no sweep yet");
  EXPECT_EQ(health.report({3, 0, 3}).message, "looking at the first sweeps");
  health.note_waiting("the transform");
  const StatusMessage waiting = health.report({4, 0, 4});
  EXPECT_EQ(waiting.level, NodeLevel::kError);
  EXPECT_EQ(waiting.message, "waiting for the transform");
}

TEST(NodeHealth, TellsTheLevelOfTheLastSweep) {
  NodeHealth health;
  std::size_t received = 0;
  const auto level = [&](OdometryStatus status) {
    health.note_sweep(with_status(status, 20));
    return health.report({++received, 0, 0}).level;
  };
  EXPECT_EQ(level(OdometryStatus::kInitialising), NodeLevel::kOk);
  EXPECT_EQ(level(OdometryStatus::kOk), NodeLevel::kOk);
  EXPECT_EQ(level(OdometryStatus::kDegenerate), NodeLevel::kWarn);
  EXPECT_EQ(level(OdometryStatus::kRecovered), NodeLevel::kWarn);
  EXPECT_EQ(level(OdometryStatus::kLost), NodeLevel::kError);
  EXPECT_EQ(level(OdometryStatus::kEmpty), NodeLevel::kError);
  SweepResult lost = with_status(OdometryStatus::kLost, 20);
  lost.stats.loss_cause = LossCause::kFitsBeside;
  health.note_sweep(lost);
  EXPECT_EQ(health.report({++received, 0, 0}).message, "lost (fits_beside)");
  health.note_reset();
  const StatusMessage reset = health.report({++received, 0, 0});
  EXPECT_EQ(reset.message, "reset, no sweep since");
  EXPECT_EQ(figure(reset, "status lost"), "2");
  EXPECT_EQ(figure(reset, "sweeps registered"), "7");
  EXPECT_EQ(figure(reset, "ms mean"), "20.00");
}

TEST(NodeHealth, TheWorstSweepSinceTheLastReportCounts) {
  NodeHealth health;
  health.note_sweep(with_status(OdometryStatus::kInitialising, 5));
  health.note_sweep(with_status(OdometryStatus::kOk, 5));
  SweepResult lost = with_status(OdometryStatus::kLost, 80);
  lost.stats.loss_cause = LossCause::kFitsBeside;
  EXPECT_EQ(health.note_sweep(lost).lost, "lost (fits_beside)");
  EXPECT_EQ(health.note_sweep(lost).lost, "") << "the first one of several";
  health.note_sweep(with_status(OdometryStatus::kOk, 5));
  health.note_end(95, 7, false);
  const StatusMessage report = health.report({5, 0, 0});
  EXPECT_EQ(report.level, NodeLevel::kError);
  EXPECT_EQ(report.message, "lost (fits_beside) since the last report");
  EXPECT_EQ(figure(report, "ms largest"), "80.00");
  EXPECT_EQ(figure(report, "ms largest with publishing"), "95.00");
  EXPECT_EQ(figure(report, "points of the map for save_map"), "7");
  health.note_sweep(with_status(OdometryStatus::kOk, 6));
  const StatusMessage next = health.report({6, 0, 0});
  EXPECT_EQ(next.level, NodeLevel::kOk);
  EXPECT_EQ(next.message, "ok");
  EXPECT_EQ(figure(next, "ms largest"), "6.00");
}

TEST(NodeHealth, ANewMapIsAnErrorUntilItWasReported) {
  NodeHealth health;
  EXPECT_EQ(health.note_sweep(with_status(OdometryStatus::kInitialising, 1)).new_map, "");
  EXPECT_NE(health.note_sweep(with_status(OdometryStatus::kInitialising, 1)).new_map, "");
  EXPECT_EQ(health.new_maps(), 1U);
  const StatusMessage report = health.report({2, 0, 0});
  EXPECT_EQ(report.level, NodeLevel::kError);
  EXPECT_THAT(report.message, HasSubstr("1 new map began"));
  health.note_sweep(with_status(OdometryStatus::kOk, 1));
  EXPECT_EQ(health.report({3, 0, 0}).level, NodeLevel::kOk);
  health.note_reset();
  EXPECT_EQ(health.new_maps(), 0U);
  EXPECT_EQ(health.note_sweep(with_status(OdometryStatus::kInitialising, 1)).new_map, "");
}

TEST(NodeHealth, WhatIsLostIsToldOnceAndCountedForEver) {
  NodeHealth health;
  health.note_sweep(with_status(OdometryStatus::kDegenerate, 1));
  health.note_bad_message("no x");
  health.note_lost(3);
  const StatusMessage first = health.report({10, 2, 0});
  EXPECT_EQ(first.level, NodeLevel::kWarn);
  EXPECT_THAT(first.message, HasSubstr("degenerate; 2 sweeps dropped"));
  EXPECT_THAT(first.message, HasSubstr("3 messages lost on the way"));
  EXPECT_THAT(first.message, HasSubstr("1 message that cannot be read"));
  const StatusMessage second = health.report({11, 2, 0});
  EXPECT_EQ(second.message, "degenerate");
  EXPECT_EQ(figure(second, "sweeps dropped"), "2");
  EXPECT_EQ(figure(second, "messages lost on the way"), "3");
  EXPECT_EQ(figure(second, "last that cannot be read"), "no x");
}

TEST(NodeHealth, WhenNoMessageCanBeReadItIsAnError) {
  NodeHealth health;
  health.note_bad_message("of another frame");
  EXPECT_EQ(health.report({1, 0, 0}).level, NodeLevel::kError);
  health.note_bad_message("of another frame");
  health.note_sweep(with_status(OdometryStatus::kOk, 1));
  EXPECT_EQ(health.report({3, 0, 0}).level, NodeLevel::kWarn);
}

// Of what was counted before, only what came since the last report.
TEST(NodeHealth, ReportsTellWhatIsNewAndTheWorstOfIt) {
  NodeHealth health;
  health.note_sweep(with_status(OdometryStatus::kLost, 30));
  health.note_sweep(with_status(OdometryStatus::kLost, 10));
  health.note_lost(3);
  EXPECT_EQ(figure(health.report({10, 2, 0}), "ms largest"), "30.00");
  health.note_lost(5);
  health.note_bad_message("no x");
  const StatusMessage second = health.report({20, 6, 0});
  EXPECT_EQ(second.level, NodeLevel::kError);
  EXPECT_THAT(second.message, HasSubstr("4 sweeps dropped"));
  EXPECT_THAT(second.message, HasSubstr("2 messages lost"));
  EXPECT_THAT(second.message, HasSubstr("1 message that cannot be read since the last report, and no other"));
  EXPECT_EQ(figure(second, "ms largest"), "0.00") << "no sweep since";
  // Lost is worse than dropped.
  EXPECT_EQ(health.report({30, 7, 0}).level, NodeLevel::kError);
}

TEST(NodeHealth, SilenceIsStale) {
  NodeHealth health;
  health.note_sweep(with_status(OdometryStatus::kOk, 1));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(health.report({1, 0, 0}).level, NodeLevel::kOk);
  EXPECT_EQ(health.report({1, 0, 0}).level, NodeLevel::kStale);
  EXPECT_EQ(health.report({2, 0, 0}).level, NodeLevel::kOk);
}

// ROS 1 knows the type of a message when it comes: one of another type does not get into the queue.
TEST(NodeHealth, MessagesOfAnotherTypeAreNoSilence) {
  NodeHealth health;
  for (int i = 0; i < 9; ++i) {
    health.note_bad_message("of another type");
    const StatusMessage report = health.report({});
    EXPECT_EQ(report.level, NodeLevel::kError) << report.message;
    EXPECT_THAT(report.message, HasSubstr("1 message that cannot be read"));
  }
}

}  // namespace
}  // namespace rilo
