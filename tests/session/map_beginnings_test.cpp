// Maps that begin again: the sentence about them, and the velocity to begin with in another pass.
#include "session/map_beginnings.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo::test {
namespace {

using testing::HasSubstr;
using testing::Not;

OdometryStatus status_of(char kind) {
  switch (kind) {
    case 'i':
      return OdometryStatus::kInitialising;
    case 'l':
      return OdometryStatus::kLost;
    case 'd':
      return OdometryStatus::kDegenerate;
    case 'e':
      return OdometryStatus::kEmpty;
    default:
      return OdometryStatus::kOk;
  }
}

/// i: initialising, l: lost, d: degenerate, e: empty, o: ok; an upper case letter is over its budget. Ten sweeps a
/// second, each with its place as its velocity.
std::vector<SweepResult> results_of(const std::string& sweeps) {
  std::vector<SweepResult> results;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    SweepResult result;
    const char kind = static_cast<char>(std::tolower(sweeps[i]));
    result.status = status_of(kind);
    result.stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(i) * 100'000'000;
    result.twist[3] = static_cast<double>(i);
    result.stats.over_budget = sweeps[i] != kind;
    results.push_back(result);
  }
  return results;
}

std::string said_of(const std::string& sweeps) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < sweeps.size(); ++i) indices.push_back(100 + i);
  return further_maps(results_of(sweeps), indices);
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

TEST(LateBeginning, NoneWhereTheFirstMapHoldsOrNoneDoes) {
  for (const char* sweeps : {"", "i", "io", "eioo", "ioooliio", "iiii", "iid", "idddlio", "idio"}) {
    EXPECT_FALSE(velocity_after_late_beginning(results_of(sweeps))) << sweeps;
  }
}

TEST(LateBeginning, NoneLongAfterTheFirstSweepOrBeforeIt) {
  std::vector<SweepResult> results = results_of("iio");
  for (const std::int64_t stamp_ns : {std::int64_t{-9'000'000'000'000'000'000}, results[0].stamp_ns,
                                      results[0].stamp_ns + 20'000'000'000, std::numeric_limits<std::int64_t>::max()}) {
    results[2].stamp_ns = stamp_ns;
    EXPECT_FALSE(velocity_after_late_beginning(results)) << stamp_ns;
  }
}

TEST(LateBeginning, TheVelocityIsThatOfTheFirstSweepThatIsVouchedFor) {
  const std::optional<KnownVelocity> known = velocity_after_late_beginning(results_of("iiiodoo"));
  ASSERT_TRUE(known);
  EXPECT_EQ(known->twist[3], 3.0);
  EXPECT_NEAR(known->at_s, 0.3, 1e-9);
  // A degenerate one does not tell all of it.
  const std::optional<KnownVelocity> later = velocity_after_late_beginning(results_of("eiiddo"));
  ASSERT_TRUE(later);
  EXPECT_EQ(later->twist[3], 5.0);
  EXPECT_NEAR(later->at_s, 0.5, 1e-9);
}

}  // namespace
}  // namespace rilo::test
