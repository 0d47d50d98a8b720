// Downsampling by the mean of every voxel.
#include "cloud/voxel_mean.hpp"

#include <map>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/voxel_key.hpp"

namespace rilo {
namespace {

TEST(VoxelMean, MeansOfPointsOffsetsAndCounts) {
  TimedCloud in;
  in.points = {{0.2F, 0.2F, 0.2F}, {5.5F, 0.5F, 0.5F}, {0.4F, 0.6F, 0.8F}};
  in.offsets_s = {-0.04F, 0.03F, -0.02F};
  in.counts = {1.0F, 1.0F, 3.0F};
  VoxelMean mean;
  TimedCloud out;
  mean.average(in, 1.0, out);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_TRUE(out.points[0].isApprox(Eigen::Vector3f(0.35F, 0.5F, 0.65F), 1e-6F));
  EXPECT_NEAR(out.offsets_s[0], -0.025F, 1e-8F);
  EXPECT_EQ(out.counts[0], 4.0F);
  EXPECT_EQ(out.points[1], in.points[1]);
  EXPECT_EQ(out.counts[1], 1.0F);
}

TEST(VoxelMean, IntensitiesCountAsOftenAsTheirPoints) {
  TimedCloud in;
  in.points = {{0.2F, 0.2F, 0.2F}, {5.5F, 0.5F, 0.5F}, {0.4F, 0.6F, 0.8F}};
  in.counts = {1.0F, 1.0F, 3.0F};
  in.intensities = {10.0F, 7.0F, 30.0F};
  VoxelMean mean;
  TimedCloud out;
  mean.average(in, 1.0, out);
  EXPECT_EQ(out.intensities, (std::vector<float>{25.0F, 7.0F}));
  in.intensities.clear();
  mean.average(in, 1.0, out);
  EXPECT_TRUE(out.intensities.empty());
}

TEST(VoxelMean, TheTwoEndsOfASweepAreNotMixed) {
  TimedCloud in;
  in.points = {{0.2F, 0.2F, 0.2F}, {0.4F, 0.4F, 0.4F}};
  in.offsets_s = {-0.05F, 0.05F};
  VoxelMean mean;
  TimedCloud out;
  mean.average(in, 1.0, out);
  EXPECT_EQ(out.points, in.points);
  EXPECT_EQ(out.offsets_s, in.offsets_s);
}

TEST(VoxelMean, EmptyOnePointAndCopies) {
  VoxelMean mean;
  TimedCloud out;
  mean.average({}, 0.5, out);
  EXPECT_EQ(out.size(), 0U);
  TimedCloud one;
  one.points = {{-3.0F, 2.0F, 1.0F}};
  mean.average(one, 0.5, out);
  EXPECT_EQ(out.points, one.points);
  EXPECT_FALSE(out.timed());
  one.points.assign(100000, one.points.front());
  mean.average(one, 0.5, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out.points.front(), one.points.front());  // no rounding, however many
  EXPECT_EQ(out.counts.front(), 100000.0F);
}

TEST(VoxelMean, EqualsSumsInDoublePrecisionOverManyCallsOnOneTable) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> coordinate(-40.0F, 40.0F);
  VoxelMean mean;
  for (const std::size_t count : {2000U, 50000U, 10U, 20000U}) {
    TimedCloud in;
    for (std::size_t i = 0; i < count; ++i) {
      in.points.emplace_back(coordinate(rng), coordinate(rng), coordinate(rng));
    }
    std::map<std::uint64_t, std::pair<Eigen::Vector3d, int>> expected;
    std::vector<std::uint64_t> order;
    for (const Eigen::Vector3f& p : in.points) {
      auto& cell = expected.try_emplace(voxel_key(voxel_of(p, 0.25)), Eigen::Vector3d::Zero(), 0).first->second;
      cell.first += p.cast<double>();
      if (++cell.second == 1) order.push_back(voxel_key(voxel_of(p, 0.25)));
    }
    TimedCloud out;
    mean.average(in, 4.0, out);
    ASSERT_EQ(out.size(), expected.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      ASSERT_EQ(voxel_key(voxel_of(out.points[i], 0.25)), order[i]) << "not as first met";
      const auto& [sum, points] = expected.at(order[i]);
      EXPECT_LT((out.points[i].cast<double>() - sum / points).norm(), 1e-5);
      EXPECT_EQ(out.counts[i], static_cast<float>(points));
    }
  }
}

}  // namespace
}  // namespace rilo
