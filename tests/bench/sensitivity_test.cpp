// Configurations that differ in one number.
#include "bench/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(Sensitivity, TheBaseStandsAtItsOwnValueOrAtTheDefault) {
  const auto all = find_sensitivities({{"defaults", {}}, {"low", {"icp.gate=1"}}, {"high", {"icp.gate=9"}}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].base, "defaults");
  EXPECT_THAT(all[0].points, ElementsAre(Pair(1.0, "low"), Pair(3.0, "defaults"), Pair(9.0, "high")));
}

TEST(Sensitivity, AKeyHasOneNameWithExpertBeforeItAndWithout) {
  const auto all =
      find_sensitivities({{"base", {"icp.gate=4"}}, {"low", {"expert.icp.gate=1"}}, {"high", {"icp.gate=9"}}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].points, ElementsAre(Pair(1.0, "low"), Pair(4.0, "base"), Pair(9.0, "high")));
}

// The default would be a wrong place for a base whose file says otherwise.
TEST(Sensitivity, WhereAFileMaySetTheKeyTheBaseHasNoPlace) {
  const std::string file = "config mine.yaml";
  EXPECT_THAT(find_sensitivities({{"base", {file}}, {"low", {file, "icp.gate=1"}}, {"high", {file, "icp.gate=9"}}}),
              IsEmpty());
  const auto all = find_sensitivities(
      {{"base", {file, "icp.gate=4"}}, {"low", {file, "icp.gate=1"}}, {"high", {file, "icp.gate=9"}}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].points.size(), 3U);
}

TEST(Sensitivity, AnotherElevationCorrectionIsAnotherChange) {
  const auto all = find_sensitivities(
      {{"base", {}}, {"low", {"icp.gate=1"}}, {"high", {"icp.gate=9"}}, {"given", {"icp.gate=5", "elevation 0.205°"}}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].points, ElementsAre(Pair(1.0, "low"), Pair(3.0, "base"), Pair(9.0, "high")));
}

}  // namespace
}  // namespace rilo
