#include <cmath>

#include <gtest/gtest.h>

#include "evaluation/percentile.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo {
namespace {

TEST(ErrorSummary, HandComputed) {
  const ErrorSummary s = summarise({4.0, 1.0, 2.0, 5.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(46.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(s.median, 3.0);
  EXPECT_DOUBLE_EQ(s.max, 5.0);
  EXPECT_DOUBLE_EQ(summarise({7.0, 1.0, 2.0}).median, 2.0);
}

TEST(ErrorSummary, EmptyIsZero) {
  const ErrorSummary s = summarise({});
  EXPECT_EQ(s.count, 0U);
  EXPECT_EQ(s.rmse, 0.0);
  EXPECT_EQ(s.max, 0.0);
}

TEST(ErrorSummary, StdSurvivesALargeMean) {
  const ErrorSummary s = summarise({1e9 + 1.0, 1e9 - 1.0});
  EXPECT_NEAR(s.std, 1.0, 1e-9);
}

TEST(Percentile, IsLinearBetweenTheNearestRanksAsInNumpy) {
  const std::vector<double> values = {10, 20, 30, 50};
  EXPECT_DOUBLE_EQ(percentile(values, 0.5), 25.0);
  EXPECT_DOUBLE_EQ(percentile(values, 0.95), 47.0);
  EXPECT_EQ(percentile(values, 0), 10.0);
  EXPECT_EQ(percentile(values, 1), 50.0);
  EXPECT_EQ(percentile({7}, 0.3), 7.0);
  EXPECT_EQ(percentile({}, 0.5), 0.0);
}

}  // namespace
}  // namespace rilo
