// Ratios, means and the sign test, against values by hand.
#include "evaluation/paired_comparison.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kLost = 10;

TEST(PairedComparison, GeometricMeanWorstAndCounts) {
  // Ratios 1/2, 2 and 1/8: their product is 1/8, its cube root 1/2.
  const PairedComparison c = compare_pairs({{"a", 1, 2}, {"b", 4, 2}, {"c", 0.5, 4}}, kLost);
  EXPECT_EQ(c.drives, 3U);
  EXPECT_NEAR(c.mean_ratio.value(), 0.5, 1e-12);
  EXPECT_NEAR(c.mean_ratio_all.value(), 0.5, 1e-12);
  EXPECT_NEAR(c.worst_ratio.value(), 2.0, 1e-12);
  EXPECT_EQ(c.worst_drive, "b");
  EXPECT_EQ(c.ahead, 2U);
  EXPECT_EQ(c.behind, 1U);
  EXPECT_NEAR(c.sign_test_p, 1.0, 1e-12);
  EXPECT_THAT(c.lost_by_us, IsEmpty());
  EXPECT_THAT(c.lost_by_them, IsEmpty());
}

TEST(PairedComparison, ALostDriveIsListedAndCountsForTheOther) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PairedComparison c = compare_pairs({{"good", 1, 4},
                                            {"we drift", 25, 1},
                                            {"we fail", std::nullopt, 1},
                                            {"they drift", 1, 100},
                                            {"they fail", 1, nan},
                                            {"they give up", 1, std::nullopt},
                                            {"both", 50, std::nullopt}},
                                           kLost);
  EXPECT_THAT(c.lost_by_us, ElementsAre("we drift", "we fail", "both"));
  EXPECT_THAT(c.lost_by_them, ElementsAre("they drift", "they fail", "they give up", "both"));
  EXPECT_NEAR(c.mean_ratio.value(), 0.25, 1e-12);
  // 1/4 · 25 · 1/100 = 1/16; the cube root of it.
  EXPECT_NEAR(c.mean_ratio_all.value(), 0.39685026299204984, 1e-12);
  EXPECT_EQ(c.worst_drive, "we drift");
  EXPECT_EQ(c.ahead, 4U);   // good, they drift, they fail, they give up
  EXPECT_EQ(c.behind, 2U);  // we drift, we fail
  EXPECT_EQ(c.drives, 7U);
  EXPECT_THAT(compare_pairs({{"at the limit", kLost, 1}}, kLost).lost_by_us, IsEmpty());
}

TEST(PairedComparison, EqualFiguresAndZeros) {
  const PairedComparison c = compare_pairs({{"equal", 2, 2}, {"exact", 0, 1}}, kLost);
  EXPECT_NEAR(c.mean_ratio.value(), 1.0, 1e-12);  // of the first alone
  EXPECT_EQ(c.ahead, 1U);
  EXPECT_EQ(c.behind, 0U);
  const PairedComparison none = compare_pairs({}, kLost);
  EXPECT_FALSE(none.mean_ratio.has_value());
  EXPECT_FALSE(none.worst_ratio.has_value());
  EXPECT_EQ(none.sign_test_p, 1.0);
}

TEST(SignTest, IsTheExactBinomial) {
  EXPECT_EQ(sign_test_p(0, 0), 1.0);
  EXPECT_NEAR(sign_test_p(1, 0), 1.0, 1e-12);
  EXPECT_NEAR(sign_test_p(5, 0), 2.0 / 32, 1e-12);
  EXPECT_NEAR(sign_test_p(0, 5), 2.0 / 32, 1e-12);
  EXPECT_NEAR(sign_test_p(8, 2), 2.0 * (1 + 10 + 45) / 1024, 1e-12);
  EXPECT_NEAR(sign_test_p(11, 1), 2.0 * (1 + 12) / 4096, 1e-12);
  EXPECT_NEAR(sign_test_p(4, 4), 1.0, 1e-12);
  const double even = sign_test_p(2000, 2001);
  EXPECT_NEAR(even, 1.0, 1e-9);
  EXPECT_LT(sign_test_p(2000, 1000), 1e-60);
}

}  // namespace
}  // namespace rilo
