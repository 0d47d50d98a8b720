// The sentence about a rate that cannot be that of the sweeps.
#include "session/assumed_rate.hpp"

#include <gtest/gtest.h>

namespace rilo::test {
namespace {

std::string said_of(std::size_t sweeps, std::size_t impossible, bool assumed = true) {
  SourceInfo info;
  info.stamps_assumed = assumed;
  std::vector<SweepResult> results(sweeps);
  for (std::size_t i = 0; i < impossible; ++i) {
    results[i].stats.impossible_motion = true;
  }
  return doubtful_rate(info, results);
}

TEST(AssumedRate, IsDoubtedWhereManySweepsLieTooFarOn) {
  EXPECT_EQ(said_of(40, 3),
            "3 of 40 sweeps lie where no sensor can have moved to since the sweep before: the data has no timestamps, "
            "and the assumed rate seems wrong; give --rate, the sweeps a second");
  EXPECT_EQ(said_of(40, 2), "");
  EXPECT_NE(said_of(500, 10), "");
  EXPECT_EQ(said_of(500, 9), "") << "missing sweeps do that now and then";
  EXPECT_EQ(said_of(40, 20, false), "") << "stamps of the data";
  EXPECT_EQ(said_of(0, 0), "");
}

}  // namespace
}  // namespace rilo::test
