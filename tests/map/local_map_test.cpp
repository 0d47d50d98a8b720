// The local map: its levels, the scene range and what it gives back.
#include "map/local_map.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/elevation.hpp"

namespace rilo {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// A flat patch at height z around (x, y), `side_m` wide.
Points patch(float x, float y, float z, float side_m, int count) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> side(-0.5F * side_m, 0.5F * side_m);
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(x + side(rng), y + side(rng), z);
  }
  return points;
}

LocalMapConfig config_of(int levels) {
  LocalMapConfig config;
  config.voxel_m = 0.25;
  config.levels = levels;
  config.radius_m = 20.0;
  return config;
}

TEST(LocalMapTest, StartsEmpty) {
  const LocalMap map(config_of(4));
  MapPlane plane;
  EXPECT_EQ(map.size(), 0U);
  EXPECT_TRUE(map.points().empty());
  EXPECT_FALSE(map.find(Eigen::Vector3d::Zero(), plane));
}

TEST(LocalMapTest, OnePointIsInEveryLevelAndGivenBackOnce) {
  LocalMap map(config_of(4));
  SE3 T_odom_lidar = SE3::Identity();
  T_odom_lidar.translation() = Eigen::Vector3d(10.0, 0.0, 0.0);
  map.insert({{1.1F, 2.1F, 3.1F}}, T_odom_lidar);
  EXPECT_EQ(map.size(), 4U);
  ASSERT_EQ(map.points().size(), 1U);
  EXPECT_TRUE(map.points()[0].isApprox(Eigen::Vector3f(11.1F, 2.1F, 3.1F), 1e-5F));
  map.clear();
  EXPECT_EQ(map.size(), 0U);
  EXPECT_TRUE(map.points().empty());
}

TEST(LocalMapTest, LookUpsBeginAtALevelOfThoseInUse) {
  LocalMap map(config_of(4));  // voxels of 0.25, 0.5, 1, 2 m
  EXPECT_EQ(map.level_of(0.0), 0U);
  EXPECT_EQ(map.level_of(0.5), 1U) << "no smaller";
  EXPECT_EQ(map.level_of(0.6), 2U);
  EXPECT_EQ(map.level_of(100.0), 3U);
  map.insert(patch(0.0F, 0.0F, 0.02F, 10.0F, 40000), SE3::Identity());
  const auto voxel_from = [&](std::size_t level) {
    double voxel_m = 0.0;
    map.visit(
        0, 1, [](std::size_t) { return Eigen::Vector3d(0.1, 0.1, 0.02); },
        [&](std::size_t, const Eigen::Vector3d&, const PlaneSpot& spot) { voxel_m = spot.grid->voxel_m(); }, level);
    return voxel_m;
  };
  EXPECT_EQ(voxel_from(0), 0.25);
  EXPECT_EQ(voxel_from(2), 1.0);
  map.set_scene_range(16.0);  // the finest in use: 0.5 m
  EXPECT_EQ(map.level_of(0.0), 1U);
  EXPECT_EQ(voxel_from(0), 0.5);
}

// Look-ups of many points, level by level, find what each level's own look-up finds: the finest plane, or the finest
// points that are not a plane.
TEST(LocalMapTest, ManyPointsMeetWhatTheirLevelsHold) {
  LocalMapConfig config = config_of(4);
  config.scatter_voxel_m = 0.5;
  LocalMap map(config);
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> side(-6.0F, 6.0F);
  Points points = patch(0.0F, 0.0F, 0.02F, 10.0F, 4000);
  for (int i = 0; i < 4000; ++i) {
    const float x = side(rng);  // one by one: compilers differ in the order of arguments
    const float y = side(rng);
    points.emplace_back(x, y, std::abs(side(rng)));
  }
  map.insert(points, SE3::Identity());
  std::vector<PlaneGrid> levels;
  for (int level = 0; level < config.levels; ++level) {
    const double voxel_m = std::ldexp(config.voxel_m, level);
    levels.emplace_back(
        voxel_m,
        PlaneCriteria{config.min_points, static_cast<int>(config.max_points * std::pow(1.5, level)),
                      config.max_planarity, config.min_extent * voxel_m, config.range_noise_m, config.angle_noise_rad});
    std::vector<InsertedPoint> inserted;
    for (const Eigen::Vector3f& p : points) {
      inserted.push_back({p.cast<double>(), p, elevation_jacobian(p)});
    }
    levels.back().insert(inserted);
    levels.back().refit();
  }
  std::vector<Eigen::Vector3d> probes;
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<double>(side(rng));
    const auto y = static_cast<double>(side(rng));
    probes.emplace_back(x, y, 0.3 * static_cast<double>(side(rng)));
  }
  std::vector<PlaneSpot> met(probes.size());
  map.visit<LocalMap::Wanted::kPlanesAndScatter>(
      0, probes.size(), [&](std::size_t k) { return probes[k]; },
      [&](std::size_t k, const Eigen::Vector3d&, const PlaneSpot& spot) { met[k] = spot; });
  int planes = 0;
  int scatters = 0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const PlaneGrid* expected = nullptr;
    PlaneSpot spot;
    for (const PlaneGrid& grid : levels) {
      if (expected == nullptr && grid.locate(probes[k], spot)) expected = &grid;
    }
    const bool plane = expected != nullptr;
    for (const PlaneGrid& grid : levels) {
      if (expected == nullptr && grid.voxel_m() >= config.scatter_voxel_m &&
          grid.look_up(grid.index_of(probes[k]), spot) == PlaneGrid::Kind::kScatter) {
        expected = &grid;
      }
    }
    ASSERT_EQ(met[k].grid != nullptr, expected != nullptr) << k;
    if (expected == nullptr) continue;
    EXPECT_EQ(met[k].grid->voxel_m(), expected->voxel_m()) << k;
    EXPECT_EQ(met[k].scatter, !plane) << k;
    EXPECT_EQ(met[k].index, spot.index) << k;
    ++(plane ? planes : scatters);
  }
  EXPECT_GT(planes, 50);
  EXPECT_GT(scatters, 50);
}

// The keys of 0.01 m voxels repeat after 21 km.
TEST(LocalMapTest, ADriveOf25KilometresWithTheSmallestVoxels) {
  LocalMapConfig config = config_of(3);
  config.voxel_m = 0.01;
  LocalMap map(config);
  const Points ground = patch(0.0F, 0.0F, 0.005F, 0.5F, 2000);
  std::size_t most = 0;
  for (int step = 0; step <= 500; ++step) {
    SE3 T_odom_lidar = SE3::Identity();
    T_odom_lidar.translation() = Eigen::Vector3d(-50.0 * step, 30.0 * step, 5.0 * step);
    map.insert(ground, T_odom_lidar);
    map.evict(T_odom_lidar.translation());
    MapPlane plane;
    ASSERT_TRUE(map.find(T_odom_lidar * Eigen::Vector3d(0.0, 0.0, 0.005), plane)) << step;
    ASSERT_NEAR((T_odom_lidar.inverse() * plane.point).norm(), 0.0, 0.05) << step;
    ASSERT_NEAR(std::abs(plane.normal.z()), 1.0, 1e-3) << step;
    if (step == 50) most = map.size();
  }
  EXPECT_LE(map.size(), 2 * most);  // what is left behind is evicted
  for (const Eigen::Vector3f& p : map.points()) ASSERT_LT((p - Eigen::Vector3f(-25000, 15000, 2500)).norm(), 3000.0F);
}

TEST(LocalMapTest, TheFinestLevelWithAPlaneAnswers) {
  LocalMap map(config_of(3));
  map.insert(patch(0.125F, 0.125F, 0.125F, 0.24F, 50), SE3::Identity());  // one fine voxel
  // Beside it the ground is sparse: no voxel of 0.25 m has enough points, the one of 1 m has.
  map.insert({{5.1F, 5.1F, 0.4F},
              {5.9F, 5.1F, 0.4F},
              {5.1F, 5.9F, 0.4F},
              {5.9F, 5.9F, 0.4F},
              {5.4F, 5.5F, 0.4F},
              {5.6F, 5.2F, 0.4F}},
             SE3::Identity());
  MapPlane plane;
  ASSERT_TRUE(map.find({0.1, 0.1, 0.1}, plane));
  EXPECT_NEAR(plane.point.z(), 0.125, 1e-6);
  EXPECT_NEAR(std::abs(plane.normal.z()), 1.0, 1e-6);
  ASSERT_TRUE(map.find({5.5, 5.5, 0.5}, plane));
  EXPECT_NEAR(plane.point.x(), 5.5, 1e-5);
  EXPECT_NEAR(plane.point.z(), 0.4, 1e-5);
  EXPECT_FALSE(map.find({-10.5, 5.5, 0.5}, plane));
}

TEST(LocalMapTest, AWiderPlaneIsTwoLevelsUp) {
  LocalMap map(config_of(4));
  PlaneSpot spot;
  const auto locate = [&](std::size_t level) {
    spot = {};
    map.visit(
        0, 1, [](std::size_t) { return Eigen::Vector3d(0.1, 0.1, 0.1); },
        [&](std::size_t, const Eigen::Vector3d&, const PlaneSpot& found) { spot = found; }, level);
    return spot.grid != nullptr;
  };
  map.insert(patch(0.125F, 0.125F, 0.125F, 0.24F, 50), SE3::Identity());
  PlaneSpot wider;
  ASSERT_TRUE(locate(0));
  EXPECT_FALSE(map.find_wider(spot, wider)) << "the patch is too small for a plane of 1 m";
  map.insert(patch(0.5F, 0.5F, 0.125F, 0.98F, 500), SE3::Identity());
  ASSERT_TRUE(locate(0));
  EXPECT_EQ(spot.grid->voxel_m(), 0.25);
  ASSERT_TRUE(map.find_wider(spot, wider));
  EXPECT_EQ(wider.grid->voxel_m(), 1.0);
  EXPECT_NEAR(std::abs(wider.grid->plane_at(wider).normal.z()), 1.0, 1e-6);
  ASSERT_TRUE(locate(2));
  EXPECT_FALSE(map.find_wider(spot, wider)) << "four levels are all";
}

TEST(LocalMapTest, TheSceneRangeChoosesTheFinestLevel) {
  // Voxels 0.25, 0.5, 1 and 2 m at 24 voxels a scene range: 6, 12 and 24 m; the last level is never alone.
  struct Case {
    double range_m;
    std::size_t levels;
  };
  for (const Case& c : {Case{0.0, 4}, Case{1.0, 4}, Case{6.0, 4}, Case{8.0, 4}, Case{9.0, 3}, Case{12.0, 3},
                        Case{24.0, 2}, Case{1000.0, 2}}) {
    LocalMapConfig config = config_of(4);
    config.scene_voxels = 24.0;
    LocalMap map(config);
    map.set_scene_range(c.range_m);
    map.insert({{0.1F, 0.1F, 0.1F}}, SE3::Identity());
    EXPECT_EQ(map.size(), c.levels) << "range " << c.range_m;
    EXPECT_EQ(map.points().size(), 1U);
  }
  LocalMap single(config_of(1));
  single.set_scene_range(1000.0);
  single.insert({{0.1F, 0.1F, 0.1F}}, SE3::Identity());
  EXPECT_EQ(single.size(), 1U);
}

TEST(LocalMapTest, FindStartsAtTheLevelOfTheScene) {
  LocalMap map(config_of(4));
  map.insert(patch(0.125F, 0.125F, 0.125F, 0.24F, 20), SE3::Identity());
  map.insert(patch(0.5F, 0.5F, 0.375F, 0.98F, 20), SE3::Identity());
  MapPlane plane;
  ASSERT_TRUE(map.find({0.1, 0.1, 0.1}, plane));
  EXPECT_NEAR(plane.point.z(), 0.125, 1e-6);
  map.set_scene_range(1000.0);
  EXPECT_FALSE(map.find({0.1, 0.1, 0.1}, plane)) << "in a voxel of 1 m both patches are no plane";
  map.set_scene_range(1.0);
  ASSERT_TRUE(map.find({0.1, 0.1, 0.1}, plane));
  EXPECT_NEAR(plane.point.z(), 0.125, 1e-6);
}

TEST(LocalMapTest, PointsAreOfTheFinestLevelThatHasThem) {
  LocalMap map(config_of(4));
  // Two ends of one coarse voxel: its centroid lies between them, where nothing was seen.
  map.insert({{0.1F, 1.9F, 0.1F}, {1.9F, 0.1F, 0.1F}}, SE3::Identity());
  EXPECT_EQ(map.points().size(), 2U);
  // A place seen when only coarse levels were in use comes from those.
  map.set_scene_range(1000.0);
  map.insert({{9.1F, 0.1F, 0.1F}}, SE3::Identity());
  EXPECT_EQ(map.points().size(), 3U);
}

TEST(LocalMapTest, EvictionDropsWhatIsFarOnAllLevels) {
  LocalMap map(config_of(4));
  const Points near = patch(0.125F, 0.125F, 0.125F, 0.24F, 20);
  map.insert(near, SE3::Identity());
  const std::size_t near_size = map.size();
  map.insert(patch(60.0F, 0.0F, 0.1F, 8.0F, 500), SE3::Identity());
  for (int i = 0; i < 32; ++i) {
    map.evict(Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(map.size(), near_size);
  MapPlane plane;
  EXPECT_TRUE(map.find({0.1, 0.1, 0.1}, plane));
  EXPECT_FALSE(map.find({60.0, 0.0, 0.1}, plane));
}

}  // namespace
}  // namespace rilo
