// One level of the map: planes, look-up across faces, eviction.
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "rilo/geometry/se3.hpp"
#include "rilo/map/plane_grid.hpp"

namespace rilo {
namespace {

constexpr PlaneCriteria kCriteria{6, 100, 0.1, 0.05};

/// Points scattered over the square of half a metre around `centre`, `noise_m` off the plane with this normal.
void insert_plane(PlaneGrid& grid, const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, int count,
                  double noise_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> side(-0.25, 0.25);
  std::normal_distribution<double> noise(0.0, 1.0);
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  for (int i = 0; i < count; ++i) {
    grid.insert(centre + side(rng) * u + side(rng) * v + noise_m * noise(rng) * normal);
  }
}

TEST(PlaneGridTest, EmptyGridHasNothing) {
  PlaneGrid grid(1.0, kCriteria);
  MapPlane plane;
  EXPECT_EQ(grid.size(), 0U);
  EXPECT_EQ(grid.voxel_m(), 1.0);
  EXPECT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_FALSE(grid.occupied({0.5, 0.5, 0.5}));
  grid.evict(Eigen::Vector3d::Zero(), 1.0);
  grid.refit();
  std::vector<Eigen::Vector3f> out;
  grid.centroids(out);
  EXPECT_TRUE(out.empty());
}

TEST(PlaneGridTest, ExactPlanes) {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  for (unsigned i = 0; i < 100; ++i) {
    const Eigen::Vector3d n = Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
    const Eigen::Vector3d centre(-7.5, 1000.5, 3.5);
    PlaneGrid grid(1.0, kCriteria);
    insert_plane(grid, centre, n, 50, 0.0, i);
    grid.refit();
    MapPlane plane;
    ASSERT_TRUE(grid.find(centre, plane));
    EXPECT_GT(std::abs(plane.normal.dot(n)), 1.0 - 1e-6);
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-6);
    EXPECT_NEAR((plane.point - centre).dot(n), 0.0, 1e-5);
    EXPECT_LT(plane.thickness_m, 1e-3F);
  }
}

TEST(PlaneGridTest, TheScatterOfTheNormalIsWhatItsCovarianceSays) {
  constexpr int kTrials = 2000;
  constexpr double kNoise = 0.01;
  const Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d said = Eigen::Matrix3d::Zero();
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> side(-0.5, 0.5);
  std::normal_distribution<double> noise(0.0, kNoise);
  for (int trial = 0; trial < kTrials; ++trial) {
    PlaneGrid grid(1.0, PlaneCriteria{6, 100, 0.2, 0.01});
    for (int i = 0; i < 20; ++i) {  // long along x, narrow along y
      grid.insert({0.5 + 0.9 * side(rng), 0.5 + 0.2 * side(rng), 0.5 + noise(rng)});
    }
    grid.refit();
    PlaneSpot spot;
    ASSERT_TRUE(grid.locate({0.5, 0.5, 0.5}, spot));
    MapPlane plane = grid.plane_at(spot);
    const Eigen::Vector3d error = (plane.normal.z() < 0.0 ? -1.0 : 1.0) * plane.normal - n;
    seen += error * error.transpose() / kTrials;
    said += grid.normal_covariance_at(spot) / kTrials;
  }
  EXPECT_NEAR(said(0, 0) / seen(0, 0), 1.0, 0.25);
  EXPECT_NEAR(said(1, 1) / seen(1, 1), 1.0, 0.25);
  EXPECT_GT(said(1, 1), 10.0 * said(0, 0));
}

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
  for (const auto& [p, ray, lever] : points) {
    PlaneSpot a;
    PlaneSpot b;
    ASSERT_EQ(together.locate(p, a), singly.locate(p, b));
    if (a.grid != nullptr) {
      EXPECT_EQ(together.plane_at(a).normal, singly.plane_at(b).normal);
      EXPECT_EQ(together.elevation_lever_at(a), singly.elevation_lever_at(b));
    }
  }
}

constexpr double kGrazing = 0.17;  // rad: ground seen from 1.7 m above at 10 m

/// Ground z = 0 in the voxel around the origin's neighbour, seen from far along −x under kGrazing, with noise along the
/// ray: `rings` rings, `spacing_m` apart on the ground.
std::vector<InsertedPoint> ground_rings(int rings, double spacing_m, double range_noise_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> along(-0.45, 0.45);
  std::normal_distribution<double> noise(0.0, range_noise_m);
  const Eigen::Vector3d ray(std::cos(kGrazing), 0.0, -std::sin(kGrazing));
  std::vector<InsertedPoint> points;
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d ground(0.5 + spacing_m * (ring - 0.5 * (rings - 1)), 0.5 + along(rng), 0.5);
      points.push_back({ground + noise(rng) * ray, (10.0 * ray).cast<float>()});
    }
  }
  return points;
}

/// Angle (rad) of the normal found at the middle of those rings from the vertical; negative when there is no plane.
double tilt_of(const std::vector<InsertedPoint>& points, const PlaneCriteria& criteria, MapPlane& plane) {
  PlaneGrid grid(1.0, criteria);
  grid.insert(points);
  grid.refit();
  if (!grid.find({0.5, 0.5, 0.5}, plane)) {
    return -1.0;
  }
  return std::acos(std::min(1.0, std::abs(plane.normal.z())));
}

TEST(PlaneGridTest, PointsOfOneBeamAreNoPlane) {
  const PlaneCriteria blind{6, 1000, 0.1, 0.01};
  PlaneCriteria noisy = blind;
  noisy.range_noise_m = 0.02;
  noisy.angle_noise_rad = 0.001;
  const std::vector<InsertedPoint> one = ground_rings(1, 0.0, 0.02, 3);
  MapPlane plane;
  // Without knowledge of the noise the plane contains the ray: it is off by the grazing angle.
  EXPECT_NEAR(tilt_of(one, blind, plane), kGrazing, 0.02);
  EXPECT_LT(tilt_of(one, noisy, plane), 0.0);
  // Nor do they count as a Gaussian: what lies across the ring was not seen.
  PlaneGrid grid(1.0, noisy);
  grid.insert(one);
  grid.refit();
  PlaneSpot spot;
  EXPECT_NE(grid.look_up(grid.index_of({0.5, 0.5, 0.5}), spot), PlaneGrid::Kind::kScatter);
}

TEST(PlaneGridTest, ANormalIsAsReliableAsItsRaysAreSpread) {
  PlaneCriteria criteria{6, 1000, 0.1, 0.01};
  criteria.angle_noise_rad = 0.001;
  double before = 0.0;
  for (const double spacing_m : {0.1, 0.2, 0.4, 0.8}) {
    MapPlane plane;
    ASSERT_GE(tilt_of(ground_rings(2, spacing_m, 0.0, 4), criteria, plane), 0.0) << spacing_m;
    // Two rings: D = spacing · sin(grazing angle) / 2; λ² = (D² / (D² + σ²))², σ = 10 m · 1 mrad.
    const double D = 0.5 * spacing_m * std::sin(kGrazing);
    const double lambda = D * D / (D * D + 1e-4);
    EXPECT_NEAR(static_cast<double>(plane.weight), lambda * lambda, 0.02) << spacing_m;
    EXPECT_GT(static_cast<double>(plane.weight), before);
    before = static_cast<double>(plane.weight);
  }
}

TEST(PlaneGridTest, RoughGroundOfFewRingsIsUnreliable) {
  PlaneCriteria criteria{6, 1000, 0.1, 0.01};
  criteria.angle_noise_rad = 1e-6;
  // Roughness moves the returns along the ray by standard deviation s. In (range, direction across): covariance
  // (D² cot² γ + s², D² cot γ; D² cot γ, D²), D = spacing · sin γ / 2. The fit's normal makes tan γ' with the ray, the
  // regression's tan γ; λ = sin² γ' / sin² γ.
  constexpr double kSpacingM = 0.3;
  const double D = 0.5 * kSpacingM * std::sin(kGrazing);
  const double cot = 1.0 / std::tan(kGrazing);
  for (const double s : {0.03, 0.06, 0.1}) {
    double sum = 0.0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      MapPlane plane;
      ASSERT_GE(tilt_of(ground_rings(2, kSpacingM, s, seed), criteria, plane), 0.0) << s;
      sum += static_cast<double>(plane.weight);
    }
    const double fit_rad = 0.5 * std::atan2(2.0 * D * D * cot, D * D * cot * cot + s * s - D * D);
    const double lambda = std::pow(std::sin(fit_rad) / std::sin(kGrazing), 2.0);
    EXPECT_NEAR(sum / 10.0, lambda * lambda, 0.06) << s;
  }
  MapPlane plane;
  EXPECT_LT(tilt_of(ground_rings(2, kSpacingM, 0.3, 1), criteria, plane), 0.0);
  // Seen from the front, noise along the ray tilts nothing.
  std::vector<InsertedPoint> front = ground_rings(2, kSpacingM, 0.05, 1);
  for (InsertedPoint& point : front) {
    point.ray = {0.0F, 0.0F, -10.0F};
  }
  ASSERT_GE(tilt_of(front, criteria, plane), 0.0);
  EXPECT_GT(plane.weight, 0.99F);
}

TEST(PlaneGridTest, NoiseAlongTheRayDoesNotTiltTheNormal) {
  PlaneCriteria blind{6, 1000, 0.1, 0.01};
  PlaneCriteria noisy = blind;
  noisy.range_noise_m = 0.03;
  double blind_sum = 0.0;
  double noisy_sum = 0.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto rings = ground_rings(3, 0.06, 0.03, seed);
    MapPlane plane;
    blind_sum += tilt_of(rings, blind, plane);
    noisy_sum += tilt_of(rings, noisy, plane);
  }
  // A bias of σ² sin γ cos γ / (D² + σ²) without it, D² = 2/3 · 0.06².
  EXPECT_NEAR(blind_sum / 20.0, 0.17 * 9e-4 / (24e-4 + 9e-4), 0.015);
  EXPECT_LT(noisy_sum / 20.0, 0.5 * blind_sum / 20.0);
  // Where there is no noise, none is taken off.
  MapPlane plane;
  EXPECT_NEAR(tilt_of(ground_rings(3, 0.2, 0.0, 1), noisy, plane), 0.0, 1e-6);
}

TEST(PlaneGridTest, AFullVoxelWithoutAPlaneGoesOnLearning) {
  PlaneCriteria criteria{6, 20, 0.1, 0.01};
  criteria.range_noise_m = 0.02;
  criteria.angle_noise_rad = 0.001;
  PlaneGrid grid(1.0, criteria);
  grid.insert(ground_rings(1, 0.0, 0.02, 5));  // standing: 40 points of one beam
  grid.refit();
  MapPlane plane;
  EXPECT_FALSE(grid.find({0.5, 0.5, 0.5}, plane));
  for (int ring = 0; ring < 4; ++ring) {  // driving: the ring moves over the ground
    std::vector<InsertedPoint> points = ground_rings(1, 0.0, 0.02, 6U + static_cast<unsigned>(ring));
    points.resize(5);
    for (InsertedPoint& point : points) {
      point.place.x() += 0.2 * (ring - 1.5);
    }
    grid.insert(points);
    grid.refit();
  }
  EXPECT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
}

TEST(PlaneGridTest, AVolumeIsAGaussian) {
  std::mt19937 rng(7);
  std::normal_distribution<double> unit(0.0, 1.0);
  PlaneGrid grid(4.0, PlaneCriteria{6, 100000, 0.1, 0.05});
  for (int i = 0; i < 20000; ++i) {
    grid.insert({2.0 + 0.1 * unit(rng), 2.0 + 0.2 * unit(rng), 2.0 + 0.3 * unit(rng)});
  }
  grid.refit();
  PlaneSpot spot;
  ASSERT_FALSE(grid.locate({2.0, 2.0, 2.0}, spot));
  ASSERT_EQ(grid.look_up(grid.index_of({2.0, 2.0, 2.0}), spot), PlaneGrid::Kind::kScatter);
  const MapScatter scatter = grid.scatter_at(spot);
  EXPECT_LT((scatter.mean - Eigen::Vector3d(2.0, 2.0, 2.0)).norm(), 0.02);
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = 0.1 * (axis + 1);
    EXPECT_NEAR(std::sqrt(scatter.variances[axis]), sigma, 0.1 * sigma);
    EXPECT_NEAR(std::abs(scatter.axes(axis, axis)), 1.0, 0.01);
    EXPECT_NEAR(scatter.bounded[axis], 1.0 - 12.0 * sigma * sigma / 16.0, 0.02);
  }
}

TEST(PlaneGridTest, NoisyPlaneHasItsThickness) {
  constexpr double kNoise = 0.02;
  PlaneGrid grid(1.0, PlaneCriteria{6, 2000, 0.1, 0.05});
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  insert_plane(grid, {0.5, 0.5, 0.5}, n, 2000, kNoise, 2);
  grid.refit();
  MapPlane plane;
  ASSERT_TRUE(grid.find({0.5, 0.5, 0.5}, plane));
  EXPECT_NEAR(plane.thickness_m, kNoise, 0.002);
  EXPECT_GT(std::abs(plane.normal.dot(n)), std::cos(0.02));
  EXPECT_NEAR((plane.point - Eigen::Vector3d(0.5, 0.5, 0.5)).dot(n), 0.0, 0.002);
}

TEST(PlaneGridTest, LinesClumpsAndVolumesAreNoPlanes) {
  PlaneGrid grid(1.0, kCriteria);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 50; ++i) {
    const double s = unit(rng);
    grid.insert({s, 0.3 + 0.2 * s, 0.5});                                 // collinear
    grid.insert({5.5, 0.5, 0.5});                                         // one place
    grid.insert({10.0 + unit(rng), unit(rng), unit(rng)});                // volume
    grid.insert({15.5 + 0.04 * unit(rng), 0.5 + 0.04 * unit(rng), 0.5});  // flat, too small to have a direction
  }
  grid.refit();
  MapPlane plane;
  for (const double x : {0.5, 5.5, 10.5, 15.5}) {
    EXPECT_TRUE(grid.occupied({x, 0.5, 0.5})) << x;
    EXPECT_FALSE(grid.find({x, 0.5, 0.5}, plane)) << x;
  }
}

TEST(PlaneGridTest, TooFewPointsAreNoPlaneAndPlanesNeedARefit) {
  PlaneGrid grid(1.0, kCriteria);
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  MapPlane plane;
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 5, 0.0, 4);
  grid.refit();
  EXPECT_FALSE(grid.find(centre, plane));
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 1, 0.0, 5);
  EXPECT_FALSE(grid.find(centre, plane));
  grid.refit();
  EXPECT_TRUE(grid.find(centre, plane));
}

TEST(PlaneGridTest, AFullVoxelTakesNoMore) {
  PlaneGrid grid(1.0, PlaneCriteria{6, 20, 0.1, 0.05});
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 20, 0.0, 6);
  std::vector<Eigen::Vector3f> before;
  grid.centroids(before);
  insert_plane(grid, {0.5, 0.5, 0.9}, Eigen::Vector3d::UnitZ(), 500, 0.0, 7);
  grid.refit();
  std::vector<Eigen::Vector3f> after;
  grid.centroids(after);
  EXPECT_EQ(before, after);
  MapPlane plane;
  ASSERT_TRUE(grid.find(centre, plane));
  EXPECT_NEAR(plane.point.z(), 0.5, 1e-6);
}

TEST(PlaneGridTest, RefitFollowsTheEvidenceAndDropsAPlaneThatWasNone) {
  PlaneGrid grid(1.0, kCriteria);
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  insert_plane(grid, centre, Eigen::Vector3d::UnitZ(), 10, 0.0, 8);
  grid.refit();
  MapPlane plane;
  ASSERT_TRUE(grid.find(centre, plane));
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int i = 0; i < 80; ++i) {
    grid.insert({unit(rng), unit(rng), unit(rng)});
  }
  grid.refit();
  EXPECT_FALSE(grid.find(centre, plane));
}

TEST(PlaneGridTest, AWallOnAFaceIsFoundFromBothSides) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double wall : {-2.0, 0.0, 3.0}) {
      Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.5);
      centre[axis] = wall;  // exactly on the face
      PlaneGrid grid(1.0, kCriteria);
      insert_plane(grid, centre, Eigen::Vector3d::Unit(axis), 50, 0.0, 10);
      grid.refit();
      for (const double off : {-0.19, -0.01, -1e-9, 0.0, 1e-9, 0.01, 0.19}) {
        MapPlane plane;
        ASSERT_TRUE(grid.find(centre + off * Eigen::Vector3d::Unit(axis), plane)) << axis << ' ' << wall << ' ' << off;
        EXPECT_NEAR(plane.point[axis], wall, 1e-6);
        EXPECT_NEAR(std::abs(plane.normal[axis]), 1.0, 1e-6);
      }
      MapPlane plane;
      EXPECT_FALSE(grid.find(centre - 0.35 * Eigen::Vector3d::Unit(axis), plane));
    }
  }
}

TEST(PlaneGridTest, TheFallbackIsTheNearestFaceOnly) {
  PlaneGrid grid(1.0, kCriteria);
  insert_plane(grid, {0.5, 0.5, 0.5}, Eigen::Vector3d::UnitZ(), 50, 0.0, 11);
  grid.refit();
  MapPlane plane;
  EXPECT_TRUE(grid.find({1.1, 0.5, 0.5}, plane));
  EXPECT_TRUE(grid.find({0.5, -0.1, 0.5}, plane));
  EXPECT_FALSE(grid.find({1.1, 0.05, 0.5}, plane));  // nearer to the face at y = 0
  EXPECT_FALSE(grid.find({1.1, 1.1, 0.5}, plane));   // across an edge
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
