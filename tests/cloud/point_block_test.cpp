// What works on a block of points gives what the same does point by point, to the last bit.
#include "cloud/point_block.hpp"

#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "cloud/beam_angles.hpp"
#include "cloud/elevation.hpp"
#include "cloud/random_points.hpp"
#include "geometry/voxel_key.hpp"

namespace rilo {
namespace {

constexpr std::size_t kSize = PointBlock::kSize;
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// Random points, and some on the axis.
std::vector<Eigen::Vector3f> points() {
  std::vector<Eigen::Vector3f> p = test::random_points(kSize, 50.0F, 7);
  p[3] = {0.0F, 0.0F, 2.0F};
  p[4] = Eigen::Vector3f::Zero();
  p[5] = {-4.0F, 0.0F, 0.0F};
  return p;
}

PointBlock block_of(const std::vector<Eigen::Vector3f>& p) {
  PointBlock block;
  block.load(p.data(), p.size());
  return block;
}

TEST(PointBlock, LoadsStoresAndFillsUpWithZeros) {
  std::vector<Eigen::Vector3f> p = points();
  p.resize(10);
  PointBlock block = block_of(points());
  block.load(p.data(), p.size());
  std::vector<Eigen::Vector3f> out(kSize, Eigen::Vector3f::Ones());
  block.store(out.data(), 10);
  EXPECT_TRUE(std::equal(p.begin(), p.end(), out.begin()));
  EXPECT_EQ(out[10], Eigen::Vector3f::Ones());
  block.store(out.data(), kSize);
  EXPECT_TRUE(std::all_of(out.begin() + 10, out.end(), [](const auto& q) { return q.isZero(0.0F); }));
}

TEST(PointBlock, BlocksCoverAllPointsOnce) {
  std::vector<std::pair<std::size_t, std::size_t>> blocks;
  for_each_block(5, 5 + 2 * kSize + 1, [&](std::size_t first, std::size_t n) { blocks.emplace_back(first, n); });
  EXPECT_EQ(blocks,
            (std::vector<std::pair<std::size_t, std::size_t>>{{5, kSize}, {5 + kSize, kSize}, {5 + 2 * kSize, 1}}));
  for_each_block(5, 5, [&](std::size_t, std::size_t) { FAIL(); });
}

TEST(PointBlock, RangeAndTimesThatAreNumbers) {
  std::vector<Eigen::Vector3f> p(kSize, Eigen::Vector3f(3.0F, 0.0F, 4.0F));
  PointBlock::Lanes<float> times{};
  p[1] = {5.1F, 0.0F, 0.0F};
  p[2] = {0.0F, 0.9F, 0.0F};
  p[3] = {kNotANumber, 3.0F, 0.0F};
  p[4] = {3.0F, 0.0F, -kInfinite};
  times[5] = kNotANumber;
  times[6] = -kInfinite;
  times[7] = 2.6F;
  times[8] = -2.6F;
  times[9] = 2.4F;
  PointBlock::Lanes<int> in_range{};
  find_in_range(block_of(p), 1.0F, 25.0F, times, in_range);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_EQ(in_range[i], i >= 1 && i <= 8 ? 0 : 1) << i;
  }
}

TEST(PointBlock, VoxelKeys) {
  std::vector<Eigen::Vector3f> p = points();
  p[6] = {-0.3F, 0.3F, 0.6F};  // on borders of voxels
  for (const double inverse : {1.0 / 0.3, 10.0, 0.5}) {
    PointBlock::Lanes<std::uint64_t> keys{};
    find_voxel_keys(block_of(p), inverse, keys);
    for (std::size_t i = 0; i < kSize; ++i) {
      EXPECT_EQ(keys[i], voxel_key(voxel_of(p[i], inverse))) << i;
    }
  }
}

TEST(PointBlock, AnglesOfBeams) {
  const std::vector<Eigen::Vector3f> p = points();
  BeamAngles angles;
  PointBlock::Lanes<float> elevation{};
  PointBlock::Lanes<float> azimuth{};
  for (std::size_t i = 0; i < kSize; ++i) {
    elevation[i] = 1e-3F * static_cast<float>(i);
    azimuth[i] = -2e-3F * static_cast<float>(i % 5);
    angles.at(static_cast<Beam>(i)) = {elevation[i], azimuth[i]};
  }
  PointBlock block = block_of(p);
  turn_beams(block, elevation, azimuth);
  std::vector<Eigen::Vector3f> turned(kSize);
  block.store(turned.data(), kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_EQ(turned[i], angles.corrected(p[i], static_cast<Beam>(i))) << i;
  }
  EXPECT_EQ(angles.corrected(p[0], kNoBeam), p[0]);
}

TEST(PointBlock, RotationInElevation) {
  const std::vector<Eigen::Vector3f> p = points();
  PointBlock block = block_of(p);
  rotate_elevation(block, ElevationRotation(0.02));
  std::vector<Eigen::Vector3f> rotated(kSize);
  block.store(rotated.data(), kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_EQ(rotated[i], ElevationRotation(0.02)(p[i])) << i;
  }
}

TEST(PointBlock, SpansOfTheTimesInRange) {
  PointBlock::Lanes<float> begins;
  PointBlock::Lanes<float> ends;
  begins.fill(0.5F);
  ends.fill(0.6F);
  PointBlock::Lanes<float> times{};
  PointBlock::Lanes<int> in_range{};
  times[1] = 0.7F;
  times[2] = times[3] = 0.1F;
  times[4] = kNotANumber;
  in_range[1] = in_range[2] = 1;
  widen_spans(times, in_range, begins, ends);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_EQ(begins[i], i == 2 ? 0.1F : 0.5F) << i;
    EXPECT_EQ(ends[i], i == 1 ? 0.7F : 0.6F) << i;
  }
}

TEST(PointBlock, PlacesRaysAndTheirDerivatives) {
  const std::vector<Eigen::Vector3f> p = points();
  const PointBlock block = block_of(p);
  SE3 T = SE3::Identity();
  T.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, -0.5, 0.8).normalized()));
  T.translation() = Eigen::Vector3d(300.1, -20.3, 4.7);
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const PoseDerivative derivative{{299.0, 1.0, -2.0}, {0.3, -0.1, 0.2}, {-3.0, 0.4, 5.0}};
  PointBlock rays;
  PointBlock jacobians;
  PlaceBlock places;
  rotate(R, block, rays);
  find_elevation_jacobians(block, jacobians);
  transform(T, block, places);
  PointBlock moved = rays;
  add_derivatives(derivative, places, moved);
  for (std::size_t i = 0; i < kSize; ++i) {
    const Eigen::Vector3d place = T * p[i].cast<double>();
    EXPECT_EQ(rays.at(i), R * p[i]) << i;
    EXPECT_EQ(jacobians.at(i), elevation_jacobian(p[i])) << i;
    EXPECT_EQ(places.at(i), place) << i;
    EXPECT_EQ(moved.at(i), rays.at(i) + derivative.at(place).cast<float>()) << i;
  }
}

TEST(PointBlock, TangentsQuadrantsAndSteps) {
  std::vector<Eigen::Vector3f> p(kSize);
  const float step = 0.1F;
  for (std::size_t i = 0; i < kSize; ++i) {
    const float azimuth = step * (static_cast<float>(i) + 0.5F);
    p[i] = {4.0F * std::cos(azimuth), 4.0F * std::sin(azimuth), 1.0F};
  }
  PointBlock::Lanes<float> tangents{};
  find_tangents(block_of(p), tangents);
  PointBlock::Lanes<int> quadrants{};
  find_quadrants(block_of(p), {1.0F, 0.0F}, 1.0F, quadrants);
  PointBlock::Lanes<int> mirrored{};
  find_quadrants(block_of(p), {1.0F, 0.0F}, -1.0F, mirrored);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_NEAR(tangents[i], 0.25F, 1e-6F);
    const int quadrant = static_cast<int>(step * (static_cast<float>(i) + 0.5F) / 1.5707964F) % 4;
    EXPECT_EQ(quadrants[i], quadrant) << i;
    EXPECT_EQ(mirrored[i], 3 - quadrant) << i;
  }
  EXPECT_EQ(steps_in_azimuth(block_of(p)), static_cast<int>(kSize) - 1);
  std::reverse(p.begin(), p.end());
  EXPECT_EQ(steps_in_azimuth(block_of(p)), 1 - static_cast<int>(kSize));
  p.resize(10);  // zeros beyond: no step
  EXPECT_EQ(steps_in_azimuth(block_of(p)), -9);
}

TEST(PointBlock, PolarCellsHoldWhatIsCloseInAngleAndRange) {
  for (const float size_rad : {0.05F, 0.11F}) {
    PointBlock::Lanes<std::uint32_t> directions;
    PointBlock::Lanes<std::uint32_t> layers;
    const std::vector<Eigen::Vector3f> some = test::random_points(40 * kSize, 50.0F, 9);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Eigen::Vector3f> first;
    for (std::size_t i = 0; i < some.size(); i += kSize) {
      PointBlock block;
      block.load(&some[i], kSize);
      find_polar_cells(block, size_rad, directions, layers);
      for (std::size_t j = 0; j < kSize; ++j) {
        const Eigen::Vector3f& p = some[i + j];
        ASSERT_LT(directions[j], kPolarDirections);
        ASSERT_EQ(layers[j], polar_layer(p.norm(), size_rad)) << p.norm();
        const Eigen::Vector3f& other = first.try_emplace({directions[j], layers[j]}, p).first->second;
        EXPECT_LT(std::acos(std::min(1.0F, p.normalized().dot(other.normalized()))), 1.6F * size_rad);
        EXPECT_LT(std::abs(std::log(p.norm() / other.norm())), 1.1F * size_rad);
      }
    }
    EXPECT_GT(first.size(), some.size() / 4);
  }
}

TEST(PointBlock, PolarLayersGrowWithTheRange) {
  std::uint32_t before = 0;
  for (float range_m = 0.005F; range_m < 1e5F; range_m *= 1.0005F) {
    const std::uint32_t layer = polar_layer(range_m, 0.05F);
    EXPECT_GE(layer, before);
    EXPECT_LE(layer, before + (before == 0 ? layer : 1));
    before = layer;
  }
  EXPECT_NEAR(polar_layer(20.0F, 0.05F) - polar_layer(10.0F, 0.05F), std::log(2.0) / 0.05, 1.0);
  EXPECT_LT(before, 1024U);
}

TEST(PointBlock, PolarCellsOfAnyNumbers) {
  PointBlock block;
  const std::vector<float> odd{0.0F, -0.0F, 1e-30F, 3e38F, -3e38F, kInfinite, -kInfinite, kNotANumber};
  for (std::size_t i = 0; i < kSize; ++i) {
    block.set(i, {odd[i % 8], odd[i / 8], odd[(i + i / 8) % 8]});
  }
  PointBlock::Lanes<std::uint32_t> directions;
  PointBlock::Lanes<std::uint32_t> layers;
  find_polar_cells(block, 0.05F, directions, layers);
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_LT(directions[i], kPolarDirections);
    EXPECT_LT(layers[i], 1024U);
  }
}

}  // namespace
}  // namespace rilo
