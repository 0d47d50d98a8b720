#include "evaluation/association.hpp"

#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/stamped_poses.hpp"

namespace rilo::test {
namespace {

using ::testing::ElementsAre;

TEST(MatchByStamp, TakesTheNearestWithinTolerance) {
  const MatchedPoses m = match_by_stamp(stamped({0, 100, 200, 300}), stamped({4, 96, 250, 311}), 10);
  EXPECT_THAT(places(m.truth), ElementsAre(0, 1));
  EXPECT_THAT(m.estimate_index, ElementsAre(0, 1));
  EXPECT_EQ(match_by_stamp(stamped({0, 100, 200, 300}), stamped({4, 96, 250, 311}), 11).truth.size(), 3U);
}

TEST(MatchByStamp, ToleranceIsInclusiveAndTiesGoToTheEarlier) {
  const MatchedPoses m = match_by_stamp(stamped({0, 100, 200}), stamped({50, 210}), 50);
  EXPECT_THAT(places(m.truth), ElementsAre(0, 2));
}

TEST(MatchByStamp, ATruePoseIsUsedOnceByTheNearest) {
  const MatchedPoses m = match_by_stamp(stamped({0, 100}), stamped({92, 99, 103, 1}), 20);
  EXPECT_THAT(places(m.truth), ElementsAre(0, 1));
  EXPECT_THAT(m.estimate_index, ElementsAre(3, 1));
  // Of two that are equally near, by the first.
  EXPECT_THAT(match_by_stamp(stamped({0, 100}), stamped({1, 95, 105}), 20).estimate_index, ElementsAre(0, 1));
}

TEST(MatchByStamp, OrderDoesNotMatterAndPosesFollow) {
  const MatchedPoses m = match_by_stamp(stamped({300, 0, 100}), stamped({101, 299}), 5);
  EXPECT_THAT(places(m.truth), ElementsAre(2, 0));
  EXPECT_THAT(m.estimate_index, ElementsAre(0, 1));
  EXPECT_EQ(m.estimate[1].translation().x(), 1.0);
}

TEST(MatchByStamp, FarStampsDoNotOverflow) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  EXPECT_THROW(match_by_stamp(stamped({kMin, kMin + 1}), stamped({kMax, kMax - 1}), 1000), std::invalid_argument);
  EXPECT_EQ(match_by_stamp(stamped({kMin, kMax}), stamped({kMax, kMin}), 0).truth.size(), 2U);
}

TEST(MatchByStamp, SaysTheToleranceInSeconds) {
  try {
    match_by_stamp(stamped({0, 100}), stamped({1'000'000'000, 2'000'000'000}), 20'000'000);
    FAIL() << "matched";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("within 0.02 s; check that both use the same clock"));
  }
}

TEST(MatchByStamp, OnePoseIsNoMatterOfClocks) {
  try {
    match_by_stamp(stamped({0}), stamped({0, 1}), 20'000'000);
    FAIL() << "matched";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "at least two poses of each are needed, found 1 true and 2 estimated");
  }
}

TEST(MatchByStamp, RefusesWhatCannotBeEvaluated) {
  EXPECT_THROW(match_by_stamp(stamped({0, 1}), stamped({0, 1}), -1), std::invalid_argument);
  EXPECT_THROW(match_by_stamp(stamped({}), stamped({0, 1}), 5), std::invalid_argument);
  EXPECT_THROW(match_by_stamp(stamped({0, 1}), stamped({}), 5), std::invalid_argument);
  EXPECT_THROW(match_by_stamp(stamped({0, 100}), stamped({0, 50}), 5), std::invalid_argument);
}

TEST(MatchByIndex, PairsEqualPlaces) {
  const MatchedPoses m = match_by_index(stamped({0, 1, 2}), stamped({7, 8, 9}));
  EXPECT_THAT(places(m.truth), ElementsAre(0, 1, 2));
  EXPECT_THAT(m.estimate_index, ElementsAre(0, 1, 2));
  EXPECT_THROW(match_by_index(stamped({0, 1, 2}), stamped({7, 8})), std::invalid_argument);
  EXPECT_THROW(match_by_index(stamped({0}), stamped({7})), std::invalid_argument);
}

TEST(PosesOf, DropsStamps) { EXPECT_EQ(poses_of(stamped({5, 6}))[1].translation().x(), 1.0); }

}  // namespace
}  // namespace rilo::test
