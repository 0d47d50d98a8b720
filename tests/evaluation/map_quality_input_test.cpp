// What the map's sharpness makes of points that say nothing, of settings without sense, and beside another program.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/floor_and_wall.hpp"
#include "evaluation/peer.hpp"
#include "rilo/evaluation/map_quality.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;

TEST(MapQuality, NothingToSee) {
  const std::vector<SE3> poses(30, SE3::Identity());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Points nothing;
  const Points one = {{10, 0, 0}};
  const Points not_finite = {{nan, 0, 0}, {10, std::numeric_limits<float>::infinity(), 0}};
  const Points too_near(10, {1, 0, 0});
  const Points too_far(10, {50, 0, 0});
  for (const Points& points : {nothing, one, not_finite, too_near, too_far}) {
    const MapQuality quality = map_quality(std::vector<Points>(30, points), poses);
    EXPECT_EQ(quality.sweeps, 30U);
    EXPECT_EQ(quality.windows, 1U);
    EXPECT_EQ(quality.places, 0U);
    EXPECT_EQ(quality.plane_rms_m.count, 0U);
    EXPECT_EQ(quality.plane_rms_p75_m, 0);
    EXPECT_EQ(quality.planar_share, 0);
    EXPECT_FALSE(quality.mean_map_entropy.has_value());
  }
  const MapQuality none = map_quality({}, {});
  EXPECT_EQ(none.sweeps, 0U);
  EXPECT_EQ(none.windows, 0U);
}

// Thirty copies of one point: no extent, so no plane either.
TEST(MapQuality, APileOfOnePointIsNoPlane) {
  const MapQuality quality =
      map_quality(std::vector<Points>(30, Points(10, {10, 0, 0})), std::vector<SE3>(30, SE3::Identity()));
  EXPECT_EQ(quality.places, 10U);
  EXPECT_EQ(quality.plane_rms_m.count, 0U);
  EXPECT_TRUE(std::isfinite(quality.mean_map_entropy.value()));
}

TEST(MapQuality, PointsThatAreNotFiniteChangeNothing) {
  Drive drive = floor_and_wall(30, 2000, 0.01);
  const MapQuality clean = map_quality(drive.sweeps, drive.poses);
  for (Points& sweep : drive.sweeps) {
    sweep.insert(sweep.begin() + 7, {std::numeric_limits<float>::quiet_NaN(), 0, 0});
    sweep.push_back({0, std::numeric_limits<float>::infinity(), 10});
  }
  const MapQuality spoilt = map_quality(drive.sweeps, drive.poses);
  EXPECT_EQ(spoilt.places, clean.places);
  EXPECT_NEAR(spoilt.plane_rms_m.median, clean.plane_rms_m.median, 1e-12);
  EXPECT_NEAR(spoilt.mean_map_entropy.value(), clean.mean_map_entropy.value(), 1e-9);
}

TEST(MapQuality, VoxelsThinEverySweep) {
  const Drive drive = floor_and_wall(30, 6000, 0.01);
  MapQualityConfig config;
  config.samples_per_window = 100000;
  const MapQuality all = map_quality(drive.sweeps, drive.poses, config);
  config.voxel_m = 0.2;
  const MapQuality thin = map_quality(drive.sweeps, drive.poses, config);
  EXPECT_LT(thin.places, all.places / 2);
  EXPECT_GT(thin.places, 200U);
  EXPECT_NEAR(thin.plane_rms_m.median, 0.01, 0.001);
}

TEST(MapQuality, WhatMakesNoSenseIsRefused) {
  const auto refused = [](const auto& change) {
    MapQualityConfig config;
    change(config);
    EXPECT_THROW(MapQualityMeter{config}, std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& c) { c.window_sweeps = 0; });
  refused([](auto& c) { c.window_sweeps = 12; });  // 4 sweeps, min_sweeps is 5
  refused([](auto& c) { c.sweep_step = 0; });
  refused([](auto& c) { c.radius_m = 0; });
  refused([&](auto& c) { c.radius_m = nan; });
  refused([](auto& c) { c.max_range_m = 3; });
  refused([&](auto& c) { c.max_range_m = nan; });
  refused([](auto& c) { c.voxel_m = -1; });
  refused([](auto& c) { c.voxel_m = 1e-6; });
  refused([](auto& c) { c.points_per_sweep = 0; });
  refused([](auto& c) { c.samples_per_window = 0; });
  refused([](auto& c) { c.min_neighbours = 3; });
  refused([](auto& c) { c.min_sweeps = 0; });
  refused([](auto& c) { c.max_planar_ratio = 0; });
  refused([](auto& c) { c.threads = -1; });
  EXPECT_THROW(map_quality({Points{}}, {}), std::invalid_argument);
  EXPECT_THROW(map_quality({Points{}}, {pose(nan, 0, 0)}), std::invalid_argument);
}

// With so few points nothing is left to chance in either program.
TEST(MapQualityPeer, AgreesWithTheIndependentProgram) {
  const fs::path peer = shared_folder() / "tools" / "mapquality.py";
  if (!fs::exists(peer)) {
    GTEST_SKIP() << "no " << peer;
  }
  if (!python_has("numpy, scipy")) {
    GTEST_SKIP() << "no /usr/bin/python3 with numpy and scipy";
  }
  const fs::path folder = fs::temp_directory_path() / ("rilo_map_quality_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const Drive drive = floor_and_wall(64, 2500, 0.01);
  std::mt19937 random(3);
  const std::vector<SE3> poses = with_drift(random, drive.poses, 0.0005, 0.003);
  for (std::size_t i = 0; i < drive.sweeps.size(); ++i) {
    std::ofstream file(folder / (std::to_string(100 + i) + ".bin"), std::ios::binary);
    for (const Eigen::Vector3f& p : drive.sweeps[i]) {
      const Eigen::Vector4f record(p.x(), p.y(), p.z(), 0);
      file.write(reinterpret_cast<const char*>(record.data()), sizeof(float) * 4);
    }
  }
  write_poses(folder / "poses.txt", poses);
  const auto theirs = peer_figures("/usr/bin/python3 '" + peer.string() + "' '" + folder.string() + "' '" +
                                   (folder / "poses.txt").string() + "' --json");
  fs::remove_all(folder);
  ASSERT_EQ(theirs.size(), 5U) << "unexpected output of the program";
  const MapQuality ours = map_quality(drive.sweeps, poses);
  EXPECT_EQ(ours.windows, 3U);
  EXPECT_EQ(static_cast<double>(ours.sweeps), theirs.at("frames"));
  EXPECT_EQ(static_cast<double>(ours.places), theirs.at("samples"));
  EXPECT_NEAR(1e3 * ours.plane_rms_m.median, theirs.at("plane_rms_mm"), 1e-8 * theirs.at("plane_rms_mm"));
  EXPECT_NEAR(1e3 * ours.plane_rms_p75_m, theirs.at("plane_p75_mm"), 1e-8 * theirs.at("plane_p75_mm"));
  EXPECT_NEAR(ours.mean_map_entropy.value(), theirs.at("mme"), 1e-8);
}

}  // namespace
}  // namespace rilo::test
