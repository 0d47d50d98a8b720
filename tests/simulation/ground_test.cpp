#include "simulation/ground.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/counter_random.hpp"
#include "simulation/solid_grid.hpp"

namespace rilo::simulation {
namespace {

class GroundTest : public testing::Test {
 protected:
  // One straight street along the x axis.
  Terrain terrain_{5};
  Ground ground_{terrain_, {{{-60, 0}, {60, 0}}}, {-50, -40}, {50, 40}};
};

TEST_F(GroundTest, RoadsAreCamberedAndPavementsRaised) {
  for (const double x : {-20.0, 0.0, 13.5}) {
    EXPECT_NEAR(ground_.height({x, 0}), terrain_.height({x, 0}), 0.005);
    EXPECT_NEAR(ground_.height({x, 2.8}) - terrain_.height({x, 2.8}), -0.25 * kGutterM, 0.005);
    EXPECT_NEAR(ground_.height({x, 5.59}) - terrain_.height({x, 5.59}), -kGutterM, 0.005);
    EXPECT_NEAR(ground_.height({x, 5.61}) - terrain_.height({x, 5.61}), kRaisedM, 0.005);
  }
  EXPECT_NEAR(ground_.street_distance({3.3, -4.2}), 4.2, 1e-3);
  EXPECT_EQ(ground_.street_distance({3.3, -30}), kFarFromStreetM);
}

TEST_F(GroundTest, RaysEndOnTheSurfaceAndNotBelow) {
  RandomStream random(1);
  int met = 0;
  int kerbs = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector2d from(random.uniform(-30, 30), random.uniform(-8, 8));
    const double azimuth = random.uniform(-M_PI, M_PI);
    const double elevation = random.uniform(-0.45, 0.02);
    Ray ray;
    ray.origin = {from.x(), from.y(), ground_.height(from) + 1.73};
    ray.direction = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation)};
    Hit hit;
    ground_.cast(ray, hit);
    if (!std::isfinite(hit.range_m)) continue;
    ++met;
    const Eigen::Vector3d p = ray.at(hit.range_m);
    const double street = ground_.street_distance(p.head<2>());
    const bool kerb = std::abs(street - kKerbM) < 0.05;
    kerbs += kerb ? 1 : 0;
    const double above = p.z() - ground_.height(p.head<2>());
    // The kerb's face is as high as the pavement above the gutter.
    EXPECT_NEAR(above, 0, kerb ? kGutterM + kRaisedM + 0.01 : 0.004) << p.transpose();
    for (double share = 0.02; share < 0.99; share += 0.02) {
      const Eigen::Vector3d q = ray.at(share * hit.range_m);
      EXPECT_GT(q.z() - ground_.height(q.head<2>()), -0.006) << "through the ground at " << q.transpose();
    }
  }
  EXPECT_GT(met, 2500);
  EXPECT_GT(kerbs, 30);
}

TEST_F(GroundTest, NothingIsMetUpwardsOutsideOrBehindNearerThings) {
  Hit hit;
  ground_.cast({{0, 0, 5}, {0, 0.6, 0.8}}, hit);
  ground_.cast({{500, 0, 5}, {0, 0, -1}}, hit);
  EXPECT_FALSE(std::isfinite(hit.range_m));
  hit.range_m = 1;
  ground_.cast({{0, 0, 5}, {0, 0, -1}}, hit);
  EXPECT_EQ(hit.range_m, 1);
}

TEST(SolidGrid, FindsWhatSearchingAllFinds) {
  RandomStream random(7);
  std::vector<Solid> solids;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d base(random.uniform(-45, 45), random.uniform(-35, 35), random.uniform(-1, 1));
    const Eigen::Vector3d size(random.uniform(0.1, 5), random.uniform(0.1, 5), random.uniform(0.5, 4));
    solids.push_back(i % 3 == 0 ? make_cylinder(base, 0.3 * size.x(), size.z(), 0.5)
                                : make_box(base, size, random.uniform(-3, 3), 0.5));
    if (i % 10 == 1) {
      solids.back().kind = SolidKind::kCanopy;
      solids.back().leaves = 0.4;
    }
  }
  const SolidGrid grid(solids, {-50, -40}, {50, 40});
  int met = 0;
  for (int i = 0; i < 5000; ++i) {
    const double azimuth = random.uniform(-M_PI, M_PI);
    const double z = random.uniform(-0.2, 0.2);
    const Ray ray{{random.uniform(-49, 49), random.uniform(-39, 39), 1.5},
                  {std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth), z}};
    Hit from_grid;
    from_grid.range_m = 60;
    Hit from_all = from_grid;
    grid.cast(ray, from_grid);
    for (const Solid& s : solids) cast(s, ray, from_all);
    ASSERT_EQ(from_grid.range_m, from_all.range_m) << i;
    met += from_all.range_m < 60 ? 1 : 0;
  }
  EXPECT_GT(met, 2000);
}

TEST(SolidGrid, RaysAlongTheAxesAndStraightUpEnd) {
  const SolidGrid grid({make_box({10, 0, 0}, {1, 1, 1}, 0, 0.5)}, {-20, -20}, {20, 20});
  Hit hit;
  grid.cast({{0.5, 0.1, 0.5}, {1, 0, 0}}, hit);
  EXPECT_DOUBLE_EQ(hit.range_m, 9);
  Hit none;
  grid.cast({{0.5, 0.1, 0.5}, {0, 1, 0}}, none);
  grid.cast({{0.5, 0.1, 0.5}, {0, 0, 1}}, none);
  EXPECT_FALSE(std::isfinite(none.range_m));
}

}  // namespace
}  // namespace rilo::simulation
