// From raw sweeps to the two clouds of the pipeline.
#include "cloud/preprocess.hpp"

#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/voxel_key.hpp"

namespace rilo {
namespace {

/// Points on the walls, the floor and the ceiling of a box around the sensor.
Sweep room(float width_m, float height_m, std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> unit(-0.5F, 0.5F);
  const float wall = width_m * height_m;
  const float floor = width_m * width_m;
  std::discrete_distribution<int> face({wall, wall, wall, wall, floor, floor});
  Sweep sweep;
  while (sweep.points.size() < count) {
    const int f = face(rng);
    Eigen::Vector3f p(unit(rng), unit(rng), unit(rng));
    p[f / 2] = f % 2 == 0 ? 0.4999F : -0.4999F;
    sweep.points.push_back(p.cwiseProduct(Eigen::Vector3f(width_m, width_m, height_m)));
  }
  return sweep;
}

PreprocessConfig wide_config() {
  PreprocessConfig config;
  config.source_points = 3000;
  config.min_voxel_m = 0.02;
  config.max_voxel_m = 5.0;
  return config;
}

TEST(PreprocessTest, OneSparseSweepDoesNotMakeTheNextExpensive) {
  const Sweep usual = room(20.0F, 4.0F, 60'000, 3);
  Preprocessor preprocessor(wide_config());
  for (int i = 0; i < 20; ++i) preprocessor.prepare(usual);
  const std::size_t before = preprocessor.prepare(usual).source.size();
  preprocessor.prepare(room(20.0F, 4.0F, 300, 4));
  const std::size_t after = preprocessor.prepare(usual).source.size();
  EXPECT_LT(after, 3 * before / 2);
}

TEST(PreprocessTest, EmptySweepAndOutOfRangeSweep) {
  Preprocessor preprocessor{PreprocessConfig{}};
  Sweep sweep;
  sweep.stamp_ns = 42;
  EXPECT_EQ(preprocessor.prepare(sweep).valid_points, 0U);
  sweep.points.assign(100, Eigen::Vector3f(500.0F, 0.0F, 0.0F));
  sweep.times_s.assign(100, 0.1F);
  const PreparedSweep& prepared = preprocessor.prepare(sweep);
  EXPECT_EQ(prepared.valid_points, 0U);
  EXPECT_EQ(prepared.source.size(), 0U);
  EXPECT_EQ(prepared.map_cloud.size(), 0U);
  EXPECT_EQ(prepared.mid_stamp_ns, 42);
  EXPECT_EQ(prepared.scene_range_m, 0.0);
}

TEST(PreprocessTest, AnEmptySweepBetweenLeavesNothingBehind) {
  Preprocessor preprocessor{wide_config()};
  const double scene = preprocessor.prepare(room(20.0F, 5.0F, 20000, 1)).scene_range_m;
  const PreparedSweep& empty = preprocessor.prepare(Sweep{});
  EXPECT_EQ(empty.source.size(), 0U);
  EXPECT_EQ(empty.map_cloud.size(), 0U);
  EXPECT_EQ(empty.scene_range_m, scene);
}

TEST(PreprocessTest, AnEmptyFirstSweepDoesNotSpoilTheSecond) {
  const Sweep sweep = room(3.0F, 3.0F, 50000, 1);
  Preprocessor fresh{wide_config()};
  Preprocessor after_empty{wide_config()};
  after_empty.prepare(Sweep{});
  EXPECT_EQ(after_empty.prepare(sweep).source.points, fresh.prepare(sweep).source.points);
}

TEST(PreprocessTest, OnePoint) {
  Preprocessor preprocessor{PreprocessConfig{}};
  Sweep sweep;
  sweep.stamp_ns = 1'000'000'000;
  sweep.points = {{3.0F, 4.0F, 0.0F}};
  sweep.times_s = {0.02F};
  for (int i = 0; i < 5; ++i) {
    const PreparedSweep& prepared = preprocessor.prepare(sweep);
    EXPECT_EQ(prepared.source.size(), 1U);
    EXPECT_EQ(prepared.map_cloud.size(), 1U);
    EXPECT_NEAR(prepared.scene_range_m, 5.0, 1e-6);
    EXPECT_EQ(prepared.source.offsets_s, std::vector<float>{0.0F});
    EXPECT_NEAR(static_cast<double>(prepared.mid_stamp_ns), 1.02e9, 10.0);
  }
}

TEST(PreprocessTest, TheVoxelFindsTheWantedNumberOfPoints) {
  struct Place {
    float width_m;
    float height_m;
  };
  for (const Place& place : {Place{3.0F, 3.0F}, Place{60.0F, 6.0F}}) {
    Preprocessor preprocessor{wide_config()};
    const Sweep sweep = room(place.width_m, place.height_m, 100000, 5);
    SCOPED_TRACE(testing::Message() << "room of " << place.width_m << " m");
    const auto first = static_cast<double>(preprocessor.prepare(sweep).source.size());
    EXPECT_NEAR(first, 3000.0, 450.0);
    for (int i = 0; i < 4; ++i) {
      preprocessor.prepare(sweep);
    }
    const PreparedSweep& settled = preprocessor.prepare(sweep);
    EXPECT_NEAR(static_cast<double>(settled.source.size()), 3000.0, 450.0);
    EXPECT_GT(settled.map_cloud.size(), settled.source.size());
  }
}

TEST(PreprocessTest, TheVoxelKeepsWithinItsLimits) {
  PreprocessConfig config = wide_config();
  config.min_voxel_m = 0.5;
  config.max_voxel_m = 0.5;
  Preprocessor preprocessor{config};
  const Sweep sweep = room(20.0F, 5.0F, 30000, 6);
  std::set<std::uint64_t> map_voxels;
  for (const Eigen::Vector3f& p : sweep.points) {
    map_voxels.insert(voxel_key(voxel_of(p, 1.0 / (config.map_voxel_ratio * 0.5))));
  }
  for (int i = 0; i < 3; ++i) {
    const PreparedSweep& prepared = preprocessor.prepare(sweep);
    EXPECT_EQ(prepared.map_cloud.size(), map_voxels.size());
    std::set<std::uint64_t> source_voxels;
    for (const Eigen::Vector3f& p : prepared.source.points) {
      EXPECT_TRUE(source_voxels.insert(voxel_key(voxel_of(p, 2.0))).second);
    }
  }
}

TEST(PreprocessTest, BothCloudsKeepCentreAndMeanTimeOfTheSweep) {
  Sweep sweep = room(20.0F, 5.0F, 20000, 7);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    sweep.times_s.push_back(1e-5F * static_cast<float>(i % 10000));
    centre += sweep.points[i].cast<double>() / static_cast<double>(sweep.points.size());
  }
  Preprocessor preprocessor{wide_config()};
  const PreparedSweep& prepared = preprocessor.prepare(sweep);
  for (const TimedCloud* cloud : {&prepared.source, &prepared.map_cloud}) {
    ASSERT_EQ(cloud->offsets_s.size(), cloud->size());
    ASSERT_EQ(cloud->counts.size(), cloud->size());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double offsets = 0.0;
    double points = 0.0;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const auto count = static_cast<double>(cloud->counts[i]);
      sum += count * cloud->points[i].cast<double>();
      offsets += count * static_cast<double>(cloud->offsets_s[i]);
      points += count;
    }
    EXPECT_EQ(points, 20000.0);
    EXPECT_LT((sum / points - centre).norm(), 1e-5);
    EXPECT_NEAR(offsets / points, 0.0, 1e-6);
  }
}

TEST(PreprocessTest, SceneRangeIsTheSmoothedMedianRange) {
  Preprocessor preprocessor{PreprocessConfig{}};
  Sweep near;
  near.points = {{2, 0, 0}, {0, 10, 0}, {0, 0, 90}};
  Sweep far;
  far.points = {{20, 0, 0}, {0, 30, 0}, {0, 0, 90}};
  EXPECT_NEAR(preprocessor.prepare(near).scene_range_m, 10.0, 1e-5);
  EXPECT_NEAR(preprocessor.prepare(far).scene_range_m, 12.0, 1e-5);  // a tenth of the way to 30 m
  for (int i = 0; i < 200; ++i) {
    preprocessor.prepare(far);
  }
  EXPECT_NEAR(preprocessor.prepare(far).scene_range_m, 30.0, 1e-3);
  preprocessor.reset();
  EXPECT_NEAR(preprocessor.prepare(near).scene_range_m, 10.0, 1e-5);
}

/// 16 beams, firing by firing, each with its ring; times from `begin_s` on.
Sweep fired(std::size_t count, float begin_s) {
  Sweep sweep = room(20.0F, 4.0F, count, 5);
  for (std::size_t i = 0; i < count; ++i) {
    sweep.rings.push_back(static_cast<std::uint16_t>(i % 16));
    sweep.times_s.push_back(begin_s + 0.1F * static_cast<float>(i) / static_cast<float>(count));
  }
  return sweep;
}

TEST(PreprocessTest, TheSampleMeetsAllBeamsAndOtherPointsInTheNextSweep) {
  const Sweep sweep = fired(16'000, 0.0F);  // four times the sample: an even stride would meet every fourth beam
  Preprocessor preprocessor(wide_config());
  EXPECT_TRUE(preprocessor.prepare(sweep).beam_sample.beams.empty()) << "nobody asked";
  preprocessor.track_beams(true);
  const BeamSample first = preprocessor.prepare(sweep).beam_sample;
  EXPECT_EQ(first.beams.size(), 3200U);
  EXPECT_EQ(first.cloud.offsets_s.size(), 3200U);
  EXPECT_EQ(std::set<Beam>(first.beams.begin(), first.beams.end()).size(), 16U);
  const BeamSample second = preprocessor.prepare(sweep).beam_sample;
  EXPECT_NE(second.cloud.points.front(), first.cloud.points.front());
}

TEST(PreprocessTest, EachPointIsSampledInTheLongRun) {
  for (const std::size_t count : {20'000U, 30'000U, 87'000U}) {  // strides 5, 7, 21
    const Sweep sweep = fired(count, 0.0F);
    Preprocessor preprocessor(wide_config());
    preprocessor.track_beams(true);
    std::set<float> times_s;
    const std::size_t stride = count / 4000 | 1U;
    for (std::size_t i = 0; i < stride; ++i) {
      const TimedCloud& cloud = preprocessor.prepare(sweep).beam_sample.cloud;
      times_s.insert(cloud.offsets_s.begin(), cloud.offsets_s.end());
    }
    EXPECT_GT(times_s.size(), count * 9 / 10) << stride;
  }
}

TEST(PreprocessTest, ResetForgetsWhatSweepsAndCalibrationTaught) {
  PreprocessConfig config = wide_config();
  Preprocessor fresh(config);
  fresh.track_beams(true);
  Preprocessor used(config);
  used.track_beams(true);
  BeamAngles angles;
  angles.at(3) = {0.01F, 0.02F};
  used.set_beam_angles(angles);
  used.set_elevation_offset(0.01);
  used.set_source_points(500.0);
  used.prepare(fired(20'000, -0.2F));
  used.reset();
  const Sweep sweep = fired(20'000, 0.0F);
  const PreparedSweep& expected = fresh.prepare(sweep);
  const PreparedSweep& after = used.prepare(sweep);
  EXPECT_EQ(after.mid_stamp_ns, expected.mid_stamp_ns);
  EXPECT_EQ(after.scene_range_m, expected.scene_range_m);
  EXPECT_EQ(after.source.points, expected.source.points);
  EXPECT_EQ(after.source.offsets_s, expected.source.offsets_s);
  EXPECT_EQ(after.beam_sample.cloud.points, expected.beam_sample.cloud.points);
}

TEST(PreprocessTest, FewerWantedPointsAreFoundAtOnce) {
  const Sweep usual = room(20.0F, 4.0F, 60'000, 3);
  Preprocessor preprocessor(wide_config());
  for (int i = 0; i < 5; ++i) preprocessor.prepare(usual);
  preprocessor.set_source_points(750.0);  // a quarter: voxels twice as wide
  EXPECT_NEAR(static_cast<double>(preprocessor.prepare(usual).source.size()), 750.0, 150.0);
}

}  // namespace
}  // namespace rilo
