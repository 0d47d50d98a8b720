// The sentence about maps that begin again.
#include "session/map_beginnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// i: initialising, l: lost, o: ok; an upper case letter is over its budget.
std::string said_of(const std::string& sweeps) {
  std::vector<SweepResult> results;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    SweepResult result;
    const char kind = static_cast<char>(std::tolower(sweeps[i]));
    result.status = kind == 'i'   ? OdometryStatus::kInitialising
                    : kind == 'l' ? OdometryStatus::kLost
                                  : OdometryStatus::kOk;
    result.stats.over_budget = sweeps[i] != kind;
    results.push_back(result);
    indices.push_back(100 + i);
  }
  return further_maps(results, indices);
}

TEST(FurtherMaps, OneMapIsNoReasonToSpeak) {
  EXPECT_EQ(said_of(""), "");
  EXPECT_EQ(said_of("iooolloo"), "");
}

TEST(FurtherMaps, TheirFirstSweepsAreNamedByPlaceInTheData) {
  EXPECT_EQ(said_of("iooolio"), "a new map begins at sweep 105: the poses before and after are connected by a guess");
  EXPECT_EQ(said_of("iooiolio"),
            "2 new maps begin, at sweeps 103 to 106: the poses before and after are connected by a guess");
}

TEST(FurtherMaps, WhereMostSweepsBeginOneTheCauseIsNamed) {
  EXPECT_THAT(said_of("iiio"), HasSubstr("neighbouring sweeps do not fit"));
  EXPECT_THAT(said_of("iioo"), Not(HasSubstr("do not fit")));
  EXPECT_THAT(said_of("IIIo"), HasSubstr("budget.sweep_ms"));
  EXPECT_THAT(said_of("IIIo"), Not(HasSubstr("do not fit")));
}

}  // namespace
}  // namespace rilo::test
