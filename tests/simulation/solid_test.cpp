#include "simulation/solid.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "simulation/counter_random.hpp"

namespace rilo::simulation {
namespace {

Hit cast_one(const Solid& solid, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Hit hit;
  cast(solid, {origin, direction.normalized()}, hit);
  return hit;
}

TEST(CounterRandom, IsUniformAndNormal) {
  constexpr int kCount = 200000;
  double sum = 0, square = 0, fourth = 0, flat = 0;
  for (int i = 0; i < kCount; ++i) {
    const double g = gaussian(hash(1, 2, i));
    sum += g;
    square += g * g;
    fourth += g * g * g * g;
    const double u = unit(hash(3, i));
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    flat += u;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(square / kCount, 1, 0.02);
  EXPECT_NEAR(fourth / kCount, 3, 0.1);
  EXPECT_NEAR(flat / kCount, 0.5, 0.005);
  EXPECT_TRUE(std::isfinite(gaussian(0)));
}

TEST(CounterRandom, DependsOnEveryKeyAndItsPlace) {
  const std::set<std::uint64_t> all = {hash(1, 2, 3), hash(1, 3, 2), hash(2, 1, 3), hash(1, 2), hash(1, 2, 3, 0)};
  EXPECT_EQ(all.size(), 5U);
}

TEST(Solid, BoxIsMetOnItsFace) {
  const Solid box = make_box({10, 0, 0}, {2, 4, 3}, 0, 0.5);
  const Hit front = cast_one(box, {0, 0, 1}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(front.range_m, 9);
  EXPECT_DOUBLE_EQ(front.cos_incidence, 1);
  EXPECT_FALSE(std::isfinite(cast_one(box, {0, 0, 3.1}, {1, 0, 0}).range_m));
  EXPECT_FALSE(std::isfinite(cast_one(box, {0, 0, 1}, {-1, 0, 0}).range_m));  // behind
  // A quarter turn swaps length and width.
  EXPECT_NEAR(cast_one(make_box({10, 0, 0}, {2, 4, 3}, M_PI / 2, 0.5), {0, 0, 1}, {1, 0, 0}).range_m, 8, 1e-12);
  const Hit slanted = cast_one(box, {6, -3, 1}, {1, 1, 0});
  EXPECT_NEAR(slanted.range_m, 3 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(slanted.cos_incidence, std::sqrt(0.5), 1e-12);
}

TEST(Solid, CylinderIsMetOnItsMantle) {
  const Solid pole = make_cylinder({5, 0, 0}, 0.5, 2, 0.5);
  EXPECT_DOUBLE_EQ(cast_one(pole, {0, 0, 1}, {1, 0, 0}).range_m, 4.5);
  EXPECT_NEAR(cast_one(pole, {0, 0.3, 1}, {1, 0, 0}).range_m, 4.6, 1e-12);
  EXPECT_NEAR(cast_one(pole, {0, 0.3, 1}, {1, 0, 0}).cos_incidence, 0.8, 1e-12);
  EXPECT_FALSE(std::isfinite(cast_one(pole, {0, 0.6, 1}, {1, 0, 0}).range_m));
  EXPECT_FALSE(std::isfinite(cast_one(pole, {0, 0, 2.1}, {1, 0, 0}).range_m));
}

class HouseTest : public testing::Test {
 protected:
  // Front at y = 0, from x = -4 to 4; two bays of 4 m with windows from 1 m to 3 m beside their middles; no doors.
  void SetUp() override {
    house_ = make_box({0, 5, 0}, {8, 10, 9}, 0, 0.5);
    house_.kind = SolidKind::kHouse;
    house_.relief = {};
    house_.relief.storey_m = 3;
    house_.relief.bay_m = 4;
    house_.relief.window_share = 0.5;
    house_.relief.sill_m = 1;
    house_.relief.window_m = 1.5;
    house_.relief.window_depth_m = 0.2;
    house_.relief.door_depth_m = 0.5;
    while (bay_has_door(0) || bay_has_door(1)) ++house_.relief.key;
  }
  bool bay_has_door(int bay) const {
    return std::abs(cast_one(house_, {-2 + 4.0 * bay, -5, 0.5}, {0, 1, 0}).range_m - 5.5) < 1e-9;
  }

  Solid house_;
};

TEST_F(HouseTest, WallsStandBetweenRecessedWindows) {
  const Hit pane = cast_one(house_, {-2, -5, 2}, {0, 1, 0});
  EXPECT_NEAR(pane.range_m, 5.2, 1e-12);
  EXPECT_TRUE(pane.glass);
  const Hit pier = cast_one(house_, {0, -5, 2}, {0, 1, 0});
  EXPECT_NEAR(pier.range_m, 5, 1e-12);
  EXPECT_FALSE(pier.glass);
  EXPECT_NEAR(cast_one(house_, {-2, -5, 0.9}, {0, 1, 0}).range_m, 5, 1e-12);    // below the sill
  EXPECT_NEAR(cast_one(house_, {-2, -5, 2.6}, {0, 1, 0}).range_m, 5, 1e-12);    // above the lintel
  EXPECT_NEAR(cast_one(house_, {-2, -5, 4.5}, {0, 1, 0}).range_m, 5.2, 1e-12);  // next storey
}

TEST_F(HouseTest, SlantedRaysMeetTheReveal) {
  // Enters the window of the first bay (x from -3 to -1) 0.1 m before its right end at 45 degrees: side, not pane.
  const Hit reveal = cast_one(house_, {-6.1, -5, 2}, {1, 1, 0});
  EXPECT_NEAR(reveal.range_m, 5.1 * std::sqrt(2), 1e-9);
  EXPECT_FALSE(reveal.glass);
  const Hit pane = cast_one(house_, {-6.3, -5, 2}, {1, 1, 0});
  EXPECT_NEAR(pane.range_m, 5.2 * std::sqrt(2), 1e-9);
  EXPECT_TRUE(pane.glass);
}

TEST_F(HouseTest, SomeBaysHaveDoors) {
  int doors = 0;
  for (house_.relief.key = 0; house_.relief.key < 200; ++house_.relief.key) doors += bay_has_door(0) ? 1 : 0;
  EXPECT_GT(doors, 20);
  EXPECT_LT(doors, 80);
}

TEST(Canopy, LeavesLieWithinAndStayInPlace) {
  Solid canopy;
  canopy.kind = SolidKind::kCanopy;
  canopy.centre = {8, 0, 2};
  canopy.half = {2, 1.5, 1};
  canopy.leaves = 0.4;
  canopy.key = 9;
  RandomStream random(4);
  int met = 0;
  constexpr int kRays = 4000;
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector3d aim = canopy.centre + Eigen::Vector3d(0, random.uniform(-1, 1), random.uniform(-0.6, 0.6));
    const Eigen::Vector3d from(0, random.uniform(-1, 1), 2);
    const Hit hit = cast_one(canopy, from, aim - from);
    if (!std::isfinite(hit.range_m)) continue;
    ++met;
    const Eigen::Vector3d p = from + hit.range_m * (aim - from).normalized();
    EXPECT_LT((p - canopy.centre).cwiseQuotient(canopy.half).norm(), 1.35);  // cells at its rim stick out a little
    // From nearer along the same ray the same leaf is met.
    const Eigen::Vector3d nearer = from + (aim - from).normalized();
    EXPECT_NEAR(cast_one(canopy, nearer, aim - from).range_m, hit.range_m - 1, 1e-9);
  }
  EXPECT_GT(met, kRays / 4);  // porous: some are stopped,
  EXPECT_LT(met, kRays);      // some go through
}

}  // namespace
}  // namespace rilo::simulation
