// Neighbour search against brute force.
#include "cloud/point_grid.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/random_points.hpp"

namespace rilo {
namespace {

using test::random_points;
using Points = std::vector<Eigen::Vector3f>;

/// All neighbours within the distance, nearest first, ties by index.
std::vector<Neighbour> brute_force(const Points& points, const Eigen::Vector3f& p, double max_distance_m) {
  std::vector<Neighbour> all;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const float distance2 = (points[i] - p).squaredNorm();
    if (distance2 <= static_cast<float>(max_distance_m * max_distance_m)) {
      all.push_back({i, distance2});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Neighbour& a, const Neighbour& b) { return a.distance2 < b.distance2; });
  return all;
}

void expect_equal_to_brute_force(const Points& points, const Points& queries, double cell_m, double max_distance_m) {
  PointGrid grid(cell_m);
  grid.build(points);
  ASSERT_EQ(grid.points(), points);
  std::vector<Neighbour> found;
  for (const Eigen::Vector3f& p : queries) {
    const std::vector<Neighbour> all = brute_force(points, p, max_distance_m);
    ASSERT_EQ(grid.count_within(p, max_distance_m), all.size());
    Neighbour one;
    ASSERT_EQ(grid.nearest(p, max_distance_m, one), !all.empty());
    if (!all.empty()) {
      ASSERT_EQ(one.index, all[0].index);
      ASSERT_EQ(one.distance2, all[0].distance2);
    }
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{5}, points.size() + 10}) {
      grid.nearest(p, k, max_distance_m, found);
      ASSERT_EQ(found.size(), std::min(k, all.size()));
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].index, all[i].index) << "neighbour " << i << " of " << k;
        ASSERT_EQ(found[i].distance2, all[i].distance2);
      }
    }
  }
}

TEST(PointGridTest, RandomPoints) {
  const Points points = random_points(800, 5.0F, 1);
  const Points queries = random_points(40, 7.0F, 2);
  for (const double cell_m : {0.3, 1.0, 20.0}) {
    for (const double reach_m : {0.2, 1.0, 2.9}) {
      SCOPED_TRACE(testing::Message() << "cell " << cell_m << " reach " << reach_m);
      expect_equal_to_brute_force(points, queries, cell_m, reach_m);
    }
  }
}

TEST(PointGridTest, TheQueriesAreThePoints) {
  const Points points = random_points(200, 2.0F, 3);
  expect_equal_to_brute_force(points, points, 0.5, 1.0);
}

TEST(PointGridTest, LatticePointsHaveTiesTheSmallerIndexWins) {
  Points points;
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    const int x = i % 6;
    const int y = i / 6 % 6;
    const int z = i / 36;
    points.emplace_back(static_cast<float>(x - 3), static_cast<float>(y - 3), static_cast<float>(z - 3));
  }
  std::shuffle(points.begin(), points.end(), std::mt19937(4));
  expect_equal_to_brute_force(points, points, 1.0, 2.0);
  expect_equal_to_brute_force(points, {{0.5F, 0.5F, 0.5F}, {0.5F, 0.0F, 0.0F}}, 0.5, 2.0);
}

TEST(PointGridTest, Duplicates) {
  Points points(50, Eigen::Vector3f(-1.0F, 0.5F, 2.0F));
  const Points others = random_points(50, 3.0F, 5);
  points.insert(points.end(), others.begin(), others.end());
  expect_equal_to_brute_force(points, points, 0.7, 1.5);
}

TEST(PointGridTest, CollinearPoints) {
  Points points;
  for (int i = 0; i < 100; ++i) {
    points.emplace_back(0.25F * static_cast<float>(i) - 12.5F, 0.0F, 0.0F);
  }
  expect_equal_to_brute_force(points, points, 0.5, 2.0);
  expect_equal_to_brute_force(points, random_points(20, 3.0F, 6), 0.5, 2.0);
}

TEST(PointGridTest, EmptyAndOne) {
  expect_equal_to_brute_force({}, {Eigen::Vector3f::Zero()}, 1.0, 5.0);
  expect_equal_to_brute_force({{1.0F, 0.0F, 0.0F}}, {Eigen::Vector3f::Zero(), {1.0F, 0.0F, 0.0F}}, 1.0, 1.0);
  PointGrid never_built(1.0);
  Neighbour one;
  EXPECT_FALSE(never_built.nearest(Eigen::Vector3f::Zero(), 1.0, one));
}

TEST(PointGridTest, RebuildForgetsTheOldCloud) {
  PointGrid grid(1.0);
  grid.build(random_points(500, 3.0F, 7));
  grid.build({{100.0F, 0.0F, 0.0F}});
  Neighbour one;
  EXPECT_FALSE(grid.nearest(Eigen::Vector3f::Zero(), 5.0, one));
  EXPECT_TRUE(grid.nearest({100.1F, 0.0F, 0.0F}, 5.0, one));
  EXPECT_EQ(one.index, 0U);
  EXPECT_EQ(grid.count_within({0.0F, 0.0F, 0.0F}, 5.0), 0U);
}

}  // namespace
}  // namespace rilo
