#include "view/budgeted_map.hpp"

#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

namespace rilo {
namespace {

std::vector<Eigen::Vector3f> line(float from_m, float to_m, float step_m) {
  std::vector<Eigen::Vector3f> points;
  for (float x = from_m; x < to_m; x += step_m) points.emplace_back(x, 0.05F, 0.05F);
  return points;
}

TEST(BudgetedMap, KeepsTheFirstPointOfAVoxelAndItsSweep) {
  BudgetedMap map(0.5, 1000);
  map.add(std::vector<Eigen::Vector3f>{{0.1F, 0.1F, 0.1F}, {0.2F, 0.2F, 0.2F}, {0.7F, 0.1F, 0.1F}}, 3);
  map.add(std::vector<Eigen::Vector3f>{{0.3F, 0.3F, 0.3F}}, 4);
  ASSERT_EQ(map.points().size(), 2U);
  EXPECT_FLOAT_EQ(map.points()[0].p.x(), 0.1F);
  EXPECT_EQ(map.points()[1].sweep, 3U);
  EXPECT_EQ(map.epoch(), 0U);
}

// A drive of 10 km, a point every 5 cm: whatever comes, no more points than allowed.
TEST(BudgetedMap, GetsCoarserRatherThanLarger) {
  constexpr std::size_t kBudget = 2000;
  BudgetedMap map(0.2, kBudget);
  for (std::uint32_t km = 0; km < 10; ++km) {
    const float from_m = 1000.0F * static_cast<float>(km);
    map.add(line(from_m, from_m + 1000.0F, 0.05F), km);
    ASSERT_LE(map.points().size(), kBudget);
  }
  EXPECT_GT(map.epoch(), 2U);
  EXPECT_GT(map.points().size(), kBudget / 4);  // it is used, too
  EXPECT_LT(map.points().front().p.x(), 10.0F);
  EXPECT_GT(map.points().back().p.x(), 9980.0F);
  std::set<std::tuple<long, long, long>> voxels;
  for (const MapPoint& point : map.points()) {
    const auto cell = [&](float v) { return static_cast<long>(static_cast<double>(v) / map.voxel_m()); };
    EXPECT_TRUE(voxels.emplace(cell(point.p.x()), cell(point.p.y()), cell(point.p.z())).second);
  }
}

TEST(BudgetedMap, PassesOverWhatIsNoPlace) {
  BudgetedMap map(0.2, 10);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  map.add(std::vector<Eigen::Vector3f>{{kNan, 0, 0}, {0, kInfinity, 0}, {0, 0, 1e30F}, {1, 2, 3}}, 0);
  EXPECT_EQ(map.points().size(), 1U);
}

TEST(BudgetedMap, RefusesSenselessArguments) {
  EXPECT_THROW(BudgetedMap(0.0, 10), std::invalid_argument);
  EXPECT_THROW(BudgetedMap(0.2, 0), std::invalid_argument);
}

}  // namespace
}  // namespace rilo
