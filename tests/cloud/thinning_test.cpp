#include "cloud/thinning.hpp"

#include <array>

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr std::size_t kFirings = 500;

Sweep firings(std::size_t beams) {
  Sweep sweep;
  sweep.stamp_ns = 7;
  for (std::size_t i = 0; i < kFirings * beams; ++i) {
    sweep.points.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    sweep.times_s.push_back(static_cast<float>(i));
    sweep.rings.push_back(static_cast<std::uint16_t>(i % beams));
  }
  return sweep;
}

TEST(Thinning, LeavesTheShareWithItsColumnsInOrder) {
  const Sweep sweep = firings(16);
  Sweep buffer;
  const SweepView kept = thinned(sweep, 0.3, buffer);
  EXPECT_NEAR(static_cast<double>(kept.points.size()), 0.3 * static_cast<double>(sweep.points.size()), 2.0);
  EXPECT_EQ(kept.stamp_ns, 7);
  ASSERT_EQ(kept.times_s.size(), kept.points.size());
  ASSERT_EQ(kept.rings.size(), kept.points.size());
  EXPECT_TRUE(kept.intensities.empty());
  for (std::size_t i = 0; i < kept.points.size(); ++i) {
    EXPECT_EQ(kept.points[i].x(), kept.times_s[i]);
    EXPECT_TRUE(i == 0 || kept.times_s[i] > kept.times_s[i - 1]);
  }
}

TEST(Thinning, NoBeamLosesMoreThanAnother) {
  for (const std::size_t beams : {16U, 64U}) {
    for (const double share : {0.1, 0.25, 0.5, 0.75}) {
      Sweep buffer;
      std::array<double, 64> counts{};
      for (const std::uint16_t ring : thinned(firings(beams), share, buffer).rings) {
        counts.at(ring) += 1.0;
      }
      for (std::size_t beam = 0; beam < beams; ++beam) {
        EXPECT_NEAR(counts.at(beam), share * kFirings, 0.03 * kFirings) << beams << " beams, share " << share;
      }
    }
  }
}

TEST(Thinning, NothingAndAll) {
  TimedCloud cloud;
  EXPECT_EQ(thinned(cloud, 0.5).size(), 0U);
  cloud.points.assign(100, Eigen::Vector3f::Ones());
  cloud.counts.assign(100, 2.0F);
  EXPECT_EQ(thinned(cloud, 1.0).size(), 100U);
  EXPECT_EQ(thinned(cloud, 1.0).counts.size(), 100U);
  EXPECT_FALSE(thinned(cloud, 1.0).timed());
  EXPECT_EQ(thinned(cloud, 0.0).size(), 0U);
}

TEST(EvenlyPicked, SpreadsOverTheOrder) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 10; ++i) {
    points.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  }
  EXPECT_EQ(evenly_picked(points, 10), points);
  EXPECT_EQ(evenly_picked(points, 100), points);
  EXPECT_TRUE(evenly_picked(points, 0).empty());
  EXPECT_TRUE(evenly_picked({}, 3).empty());
  const auto picked = evenly_picked(points, 4);
  EXPECT_EQ(picked, (std::vector<Eigen::Vector3f>{{0, 0, 0}, {2, 0, 0}, {5, 0, 0}, {7, 0, 0}}));
}

}  // namespace
}  // namespace rilo
