// The median.
#include "geometry/median.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace rilo {
namespace {

TEST(Median, IsTheMiddleOneWhateverTheOrder) {
  for (std::vector<int> values : {std::vector{3, 1, 2}, std::vector{2, 3, 1}, std::vector{1, 2, 3}}) {
    EXPECT_EQ(upper_median(std::span(values)), 2);
  }
}

TEST(Median, OfAnEvenNumberIsTheUpperOne) {
  std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(upper_median(std::span(values)), 3.0);
}

TEST(Median, OfOneIsIt) {
  std::vector<double> one = {7.0};
  EXPECT_EQ(upper_median(std::span(one)), 7.0);
}

}  // namespace
}  // namespace rilo
