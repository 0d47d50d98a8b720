// The hash table of a level: many points at once, eviction, growth.
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "map/plane_grid.hpp"
#include "map/plane_points.hpp"

namespace rilo {
namespace {

using test::insert_plane;
using test::kCriteria;

TEST(PlaneGridTest, ManyPointsAtOnceAreTheSameAsOneByOne) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> side(-4.0, 4.0);
  std::vector<InsertedPoint> points;
  for (int i = 0; i < 5003; ++i) {
    const Eigen::Vector3d place(side(rng), side(rng), 0.3 * side(rng));
    points.push_back({place, place.cast<float>() + Eigen::Vector3f::Ones(), place.cast<float>()});
  }
  PlaneGrid together(1.0, kCriteria);
  PlaneGrid singly(1.0, kCriteria);
  together.insert(points);
  for (const InsertedPoint& point : points) {
    singly.insert(point);
  }
  together.refit();
  singly.refit();
  EXPECT_EQ(together.size(), singly.size());
  for (const auto& [p, ray, jacobian] : points) {
    PlaneSpot a;
    PlaneSpot b;
    ASSERT_EQ(together.locate(p, a), singly.locate(p, b));
    if (a.grid != nullptr) {
      EXPECT_EQ(together.plane_at(a).normal, singly.plane_at(b).normal);
      EXPECT_EQ(together.elevation_jacobian_at(a, p, {}), singly.elevation_jacobian_at(b, p, {}));
    }
  }
}

TEST(PlaneGridTest, RunsOfPointsFromFinerVoxelsAreTheSameAsOneByOne) {
  // Along a line with a step back now and then, across the borders of voxels of both signs, until voxels are full.
  std::vector<InsertedPoint> points;
  std::vector<InsertedVoxel> voxels;
  constexpr int kDoublings = 2;
  const PlaneGrid finer(0.25, kCriteria);
  for (int i = 0; i < 40000; ++i) {
    const double along = 0.011 * ((i % 1000) - (i % 7 == 0 ? 40 : 0)) - 5.0;
    const Eigen::Vector3d place(along, 0.3 * std::sin(0.9 * i), 0.001 * (i % 13) - 0.005 * along);
    points.push_back({place, place.cast<float>() + Eigen::Vector3f::Ones(), place.cast<float>()});
    const VoxelIndex voxel = finer.index_of(place);
    voxels.push_back(i == 0 ? InsertedVoxel(voxel) : InsertedVoxel(voxel, voxels.back().index));
  }
  PlaneGrid runs(1.0, kCriteria);
  PlaneGrid singly(1.0, kCriteria);
  for (int round = 0; round < 3; ++round) {
    runs.insert(points, voxels, kDoublings);
    runs.refit();
    for (const InsertedPoint& point : points) {
      singly.insert(point);
    }
    singly.refit();
  }
  EXPECT_EQ(runs.size(), singly.size());
  std::size_t found = 0;
  for (const auto& [p, ray, jacobian] : points) {
    PlaneSpot a;
    PlaneSpot b;
    ASSERT_EQ(runs.locate(p, a), singly.locate(p, b));
    if (a.grid != nullptr) {
      ++found;
      ASSERT_EQ(runs.plane_at(a).normal, singly.plane_at(b).normal);
      ASSERT_EQ(runs.plane_at(a).point, singly.plane_at(b).point);
      ASSERT_EQ(runs.elevation_jacobian_at(a, p, {}), singly.elevation_jacobian_at(b, p, {}));
    }
  }
  EXPECT_GT(found, points.size() / 2);
}

TEST(PlaneGridTest, EvictionBeforeTheRefitLeavesNoHalfFittedVoxel) {
  PlaneGrid grid(1.0, kCriteria);
  insert_plane(grid, {100.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 10, 0.0, 12);
  grid.evict(Eigen::Vector3d::Zero(), 10.0);
  ASSERT_EQ(grid.size(), 0U);
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 5, 0.0, 13);  // takes the evicted voxel's place
  grid.refit();
  MapPlane plane;
  EXPECT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
}

/// What the grid should hold: the voxels' point counts.
class Model {
 public:
  using Key = std::tuple<int, int, int>;
  void insert(const Eigen::Vector3d& p, double inverse) {
    const VoxelIndex v = voxel_of(p, inverse);
    ++voxels_[{v.x, v.y, v.z}];
  }
  std::map<Key, int>& voxels() { return voxels_; }
  static Eigen::Vector3d centre(const Key& k, double voxel_m) {
    return voxel_m * Eigen::Vector3d(std::get<0>(k) + 0.5, std::get<1>(k) + 0.5, std::get<2>(k) + 0.5);
  }

 private:
  std::map<Key, int> voxels_;
};

void expect_same(const PlaneGrid& grid, Model& model) {
  ASSERT_EQ(grid.size(), model.voxels().size());
  for (const auto& [key, count] : model.voxels()) {
    ASSERT_TRUE(grid.occupied(Model::centre(key, grid.voxel_m())));
  }
  std::vector<Eigen::Vector3f> centroids;
  grid.centroids(centroids);
  ASSERT_EQ(centroids.size(), model.voxels().size());
}

TEST(PlaneGridTest, InsertAndEvictAgreeWithAMap) {
  constexpr double kVoxel = 0.5;
  constexpr double kRadius = 12.0;
  PlaneGrid grid(kVoxel, kCriteria);
  Model model;
  std::mt19937 rng(14);
  std::normal_distribution<double> spread(0.0, 6.0);
  std::uniform_int_distribution<int> inserts(0, 3000);
  Eigen::Vector3d centre(-40.0, 0.0, 0.0);
  for (int round = 0; round < 60; ++round) {
    for (int i = inserts(rng); i > 0; --i) {
      const Eigen::Vector3d p = centre + Eigen::Vector3d(spread(rng), spread(rng), 0.3 * spread(rng));
      grid.insert(p);
      model.insert(p, 1.0 / kVoxel);
    }
    grid.refit();
    expect_same(grid, model);
    centre.x() += 2.0;
    // A slice may take far voxels only; a full round takes all of them.
    grid.evict(centre, kRadius);
    ASSERT_LE(grid.size(), model.voxels().size());
    for (int i = 1; i < 32; ++i) {
      grid.evict(centre, kRadius);
    }
    std::erase_if(model.voxels(),
                  [&](const auto& v) { return (Model::centre(v.first, kVoxel) - centre).norm() > kRadius; });
    expect_same(grid, model);
  }
  EXPECT_GT(grid.size(), 2048U);  // the table has grown beyond its first size
}

TEST(PlaneGridTest, PlanesSurviveTheGrowthOfTheTable) {
  PlaneGrid grid(1.0, kCriteria);
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitX(), 50, 0.0, 15);
  grid.refit();
  for (int x = -40; x < 40; ++x) {
    for (int y = -40; y < 40; ++y) {
      for (int z = 2; z < 5; ++z) {
        grid.insert({x + 0.5, y + 0.5, z + 0.5});
      }
    }
  }
  EXPECT_EQ(grid.size(), 80U * 80U * 3U + 1U);
  MapPlane plane;
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_NEAR(std::abs(plane.normal.x()), 1.0, 1e-6);
}

}  // namespace
}  // namespace rilo
