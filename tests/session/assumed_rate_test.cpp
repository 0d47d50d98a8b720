// The sentence about a rate that cannot be that of the sweeps.
#include "session/assumed_rate.hpp"

#include <gtest/gtest.h>

namespace rilo::test {
namespace {

std::string said_of(const std::vector<SweepResult>& results, bool assumed = true) {
  SourceInfo info;
  info.period_s = 0.05;
  info.stamps_assumed = assumed;
  return doubtful_rate(info, results);
}

/// A drive whose last `astray` sweeps have that status.
std::vector<SweepResult> drive(std::size_t sweeps, std::size_t astray, OdometryStatus status) {
  std::vector<SweepResult> results(sweeps);
  for (SweepResult& result : results) result.status = OdometryStatus::kOk;
  if (sweeps > 0) results[0].status = OdometryStatus::kInitialising;
  for (std::size_t i = sweeps - astray; i < sweeps; ++i) results[i].status = status;
  return results;
}

std::vector<SweepResult> jumping_drive(std::size_t sweeps, std::size_t jumps) {
  std::vector<SweepResult> results = drive(sweeps, jumps, OdometryStatus::kOk);
  for (std::size_t i = sweeps - jumps; i < sweeps; ++i) results[i].stats.impossible_motion = true;
  return results;
}

TEST(AssumedRate, IsDoubtedWhereManySweepsLieTooFarOn) {
  EXPECT_EQ(said_of(jumping_drive(40, 3)),
            "3 of 40 sweeps are lost, or lie where no sensor can have moved to since the sweep before: the data has no "
            "timestamps, and the 20 Hz assumed may be wrong; give --rate, the sweeps a second");
  EXPECT_EQ(said_of(jumping_drive(40, 2)), "");
  EXPECT_NE(said_of(jumping_drive(500, 10)), "");
  EXPECT_EQ(said_of(jumping_drive(500, 9)), "") << "missing sweeps do that now and then";
  EXPECT_EQ(said_of(jumping_drive(40, 20), false), "") << "stamps of the data";
  EXPECT_EQ(said_of({}), "");
}

// Taken for five times as fast as it was, a robot is expected to go on as before: where it turns it is lost.
TEST(AssumedRate, IsDoubtedWhereManySweepsAreLost) {
  for (const OdometryStatus status : {OdometryStatus::kLost, OdometryStatus::kInitialising}) {
    EXPECT_NE(said_of(drive(40, 3, status)), "");
    EXPECT_EQ(said_of(drive(40, 2, status)), "") << "the first sweep is no evidence";
    EXPECT_EQ(said_of(drive(40, 20, status), false), "");
  }
  EXPECT_EQ(said_of(drive(40, 20, OdometryStatus::kDegenerate)), "") << "a tunnel at any rate";
}

}  // namespace
}  // namespace rilo::test
