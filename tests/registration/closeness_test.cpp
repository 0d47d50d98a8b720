// How closely a sweep lies on the map.
#include "registration/closeness.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "registration/registration_scenes.hpp"

namespace rilo::test {
namespace {

constexpr double kScaleM = 0.05;
constexpr float kWallM = 6.13F;

/// Points in front of the wall of a room, by distance.
TimedCloud in_front(const std::vector<float>& distances_m) {
  TimedCloud cloud;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    cloud.points.emplace_back(kWallM - distances_m[i], 0.1F * static_cast<float>(i) + 0.05F, 0.1F);
  }
  return cloud;
}

Closeness closeness_of(const TimedCloud& cloud) {
  return closeness({cloud, {}, kScaleM, AdaptiveIcpConfig{}}, map_of(rimless_room(0.13, 0.0)));
}

TEST(Closeness, OfPointsAtKnownDistances) {
  const Closeness near = closeness_of(in_front({0.02F, 0.02F, 0.04F, 0.04F, 0.16F}));
  EXPECT_NEAR(near.share, 0.8, 1e-9) << "beyond three times the scale a point does not count";
  // Weights 1 / (1 + (e / 0.05)²): 1 / 1.16 and 1 / 1.64.
  const double far = 1.0 / 1.64;
  const double close = 1.0 / 1.16;
  EXPECT_NEAR(near.rms_m, std::sqrt((close * 4e-4 + far * 16e-4) / (close + far)), 1e-4);
}

TEST(Closeness, NothingOfNoPointsOrNoPlane) {
  for (const TimedCloud& cloud : {TimedCloud{}, in_front({3.0F, 4.0F})}) {
    EXPECT_EQ(closeness_of(cloud).share, 0.0);
    EXPECT_EQ(closeness_of(cloud).rms_m, 0.0);
  }
}

}  // namespace
}  // namespace rilo::test
