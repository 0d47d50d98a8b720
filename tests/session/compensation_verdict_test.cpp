// What the counts of a trial say: raw, compensated, or not certain.
#include <gtest/gtest.h>

#include "session/compensation_trial.hpp"

namespace rilo::test {
namespace {

TEST(CompensationVerdict, IsCertainFromTenSweepsOnOfWhichATenthMayBeLost) {
  const auto trial = [](std::size_t sweeps, std::size_t better, std::size_t lost) {
    return CompensationTrial{PointTimes::kOrder, sweeps, better, 0, 0, lost};
  };
  EXPECT_FALSE(trial(9, 9, 0).certain());
  EXPECT_TRUE(trial(10, 5, 1).certain());
  EXPECT_FALSE(trial(10, 5, 2).certain());
  EXPECT_TRUE(trial(10, 6, 0).raw());
  EXPECT_FALSE(trial(10, 5, 0).raw());
  EXPECT_FALSE(trial(10, 10, 2).raw());
  EXPECT_TRUE(trial(10, 4, 0).compensated());
  EXPECT_FALSE(trial(10, 5, 0).compensated());
  EXPECT_FALSE(trial(10, 0, 2).compensated());
}

// KITTI's compensated sweeps fit better with the times, too.
TEST(CompensationVerdict, OffTheConesIsCompensatedWhateverTheFit) {
  for (const PointTimes times : {PointTimes::kOrder, PointTimes::kAzimuth}) {
    CompensationTrial trial{times, 13, 13, 0, 7, 0};
    EXPECT_FALSE(trial.raw());
    EXPECT_TRUE(trial.compensated());
    trial.lost = 13;
    EXPECT_TRUE(trial.compensated());
    trial = {times, 9, 9, 0, 9, 0};
    EXPECT_FALSE(trial.compensated()) << "too few";
  }
  const CompensationTrial few{PointTimes::kOrder, 13, 13, 0, 6, 0};
  EXPECT_TRUE(few.raw());
}

TEST(CompensationVerdict, OnTheConesIsRawWhereItFits) {
  const CompensationTrial at_one_instant{PointTimes::kOrder, 13, 4, 13, 0, 0};  // as some simulators make them
  EXPECT_FALSE(at_one_instant.raw());
  EXPECT_TRUE(at_one_instant.compensated());
  CompensationTrial trial{PointTimes::kAzimuth, 13, 8, 7, 0, 0};
  EXPECT_TRUE(trial.raw());
  trial.better = 7;
  EXPECT_FALSE(trial.raw());
  trial.better = 0;
  EXPECT_FALSE(trial.compensated()) << "or raw, turning the other way";
  trial = {PointTimes::kAzimuth, 13, 13, 6, 0, 0};
  EXPECT_FALSE(trial.raw());
  trial = {PointTimes::kAzimuth, 13, 13, 13, 0, 2};
  EXPECT_FALSE(trial.raw());
}

}  // namespace
}  // namespace rilo::test
