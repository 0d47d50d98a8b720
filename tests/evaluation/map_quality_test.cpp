#include "rilo/evaluation/map_quality.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/floor_and_wall.hpp"

namespace rilo::test {
namespace {

MapQualityConfig every_sweep(std::size_t window) {
  MapQualityConfig config;
  config.window_sweeps = window;
  config.sweep_step = 1;
  return config;
}

void expect_same(const MapQuality& a, const MapQuality& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.places, b.places);
  EXPECT_EQ(a.bounded_rms_m, b.bounded_rms_m);
  EXPECT_EQ(a.plane_rms_m.median, b.plane_rms_m.median);
  EXPECT_EQ(a.plane_rms_m.mean, b.plane_rms_m.mean);
  EXPECT_EQ(a.plane_rms_p75_m, b.plane_rms_p75_m);
  EXPECT_EQ(a.mean_map_entropy, b.mean_map_entropy);
}

// Islands of 21 points of a lattice (i² + j² ≤ 5). The first sweep sees their centres only, eight more see all, and
// their poses are d too high and d too low in turn: the variance across is 8 · 21 d² / 168 = d², along the plane it is
// 8 · 34 pitch² / 168. All numbers are exact in binary.
TEST(MapQuality, IslandsByHand) {
  constexpr double kPitch = 0.125;
  constexpr double kD = 1.0 / 64;
  Drive drive;
  for (int s = 0; s < 9; ++s) {
    Points points;
    for (int island = 0; island < 20; ++island) {
      for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
          if (i * i + j * j <= (s == 0 ? 0 : 5)) {
            points.emplace_back(static_cast<float>(5 + island + i * kPitch), static_cast<float>(j * kPitch), -1.0F);
          }
        }
      }
    }
    drive.sweeps.push_back(points);
    drive.poses.push_back(pose(0, 0, s == 0 ? 0 : (s % 2 == 0 ? kD : -kD)));
  }
  const MapQuality quality = map_quality(drive.sweeps, drive.poses, every_sweep(9));
  EXPECT_EQ(quality.sweeps, 9U);
  EXPECT_EQ(quality.windows, 1U);
  EXPECT_EQ(quality.places, 20U);
  EXPECT_EQ(quality.plane_rms_m.count, 20U);
  EXPECT_EQ(quality.samples, 20U);
  EXPECT_EQ(quality.planar_share, 1);
  EXPECT_NEAR(quality.bounded_rms_m, kD, 1e-14);
  EXPECT_NEAR(quality.plane_rms_m.median, kD, 1e-14);
  EXPECT_NEAR(quality.plane_rms_m.mean, kD, 1e-14);
  EXPECT_NEAR(quality.plane_rms_p75_m, kD, 1e-14);
  const double along = 8 * 34 * kPitch * kPitch / 168;
  const double entropy = 1.5 * std::log(2 * std::numbers::pi * std::numbers::e) + std::log(along) + std::log(kD);
  EXPECT_NEAR(quality.mean_map_entropy.value(), entropy, 1e-12);
}

// Discs of 13 points of a lattice (i² + j² ≤ 4), one for each height: the first of nine sweeps sees their centres only,
// the others all points, so much too high and too low in turn. j is squeezed by `squeeze`.
Drive discs(const std::vector<double>& heights_m, double squeeze = 1) {
  constexpr double kPitch = 0.125;
  Drive drive;
  for (int s = 0; s < 9; ++s) {
    Points points;
    for (std::size_t disc = 0; disc < heights_m.size(); ++disc) {
      const double up = s == 0 ? 0 : (s % 2 == 0 ? heights_m[disc] : -heights_m[disc]);
      for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
          if (i * i + j * j > (s == 0 ? 0 : 4)) continue;
          points.push_back(
              Eigen::Vector3d(5 + static_cast<double>(disc) + i * kPitch, j * kPitch * squeeze, up - 1).cast<float>());
        }
      }
    }
    drive.sweeps.push_back(points);
    drive.poses.push_back(SE3::Identity());
  }
  return drive;
}

// The mean square height is that of the disc: figures of five discs by hand.
TEST(MapQuality, PercentileByHand) {
  constexpr double kStep = 1.0 / 256;
  const Drive drive = discs({2 * kStep, kStep, 5 * kStep, 4 * kStep, 3 * kStep});
  const MapQuality quality = map_quality(drive.sweeps, drive.poses, every_sweep(9));
  EXPECT_EQ(quality.plane_rms_m.count, 5U);
  EXPECT_NEAR(quality.plane_rms_m.median, 3 * kStep, 1e-12);
  EXPECT_NEAR(quality.plane_rms_p75_m, 4 * kStep, 1e-12);
}

// The outermost points are exactly at the radius. A place has 8 · 13 + 1 points of 9 sweeps.
TEST(MapQuality, WhatIsJustEnoughCounts) {
  Drive drive = discs({0, 0});
  MapQualityConfig config = every_sweep(9);
  const auto places = [&] { return map_quality(drive.sweeps, drive.poses, config).places; };
  config.radius_m = 0.25;
  config.min_neighbours = 105;
  config.min_sweeps = 9;
  EXPECT_EQ(places(), 2U);
  config.min_neighbours = 106;
  EXPECT_EQ(places(), 0U);
  config.min_neighbours = 50;
  drive.sweeps.back().clear();
  EXPECT_EQ(places(), 0U);
}

// Along 14 pitch² / 13 on average, across a 64th of it, and 1/64 m up: a stick, whose middle eigenvalue is too small.
TEST(MapQuality, AStickIsNoPlane) {
  const Drive drive = discs({1.0 / 64}, 1.0 / 8);
  const MapQuality quality = map_quality(drive.sweeps, drive.poses, every_sweep(9));
  EXPECT_EQ(quality.samples, 1U);
  EXPECT_EQ(quality.places, 1U);
  EXPECT_EQ(quality.plane_rms_m.count, 0U);
  EXPECT_EQ(quality.planar_share, 0);
  EXPECT_NEAR(quality.bounded_rms_m, std::sqrt(0.1) * 0.3 / 2, 1e-12);
}

// A smooth floor and a rough wall ahead, 0.1 m nearer with every sweep. Where the length of the way is wrong the wall
// is there several times, no longer planar, and only the floor is left to be measured.
TEST(MapQuality, PosesThatLoseTheThickPlanesAreNotBetter) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-1, 1);
  std::normal_distribution<double> noise;
  Drive drive;
  drive.poses = straight_line(30, 0.1);
  for (const SE3& T : drive.poses) {
    Points sweep;
    for (int k = 0; k < 4000; ++k) {
      const Eigen::Vector3d p =
          k % 4 == 0 ? Eigen::Vector3d(10 + across(random), across(random), -1.5 + 0.01 * noise(random))
                     : Eigen::Vector3d(15 + 0.03 * noise(random), 2 * across(random), 2 + across(random));
      sweep.push_back((T.inverse() * p).cast<float>());
    }
    drive.sweeps.push_back(sweep);
  }
  const MapQuality right = map_quality(drive.sweeps, drive.poses);
  EXPECT_EQ(right.samples, 3000U);
  EXPECT_GT(right.planar_share, 0.9);
  for (const double scale : {0.7, 0.9, 1.2}) {
    const MapQuality wrong = map_quality(drive.sweeps, straight_line(30, scale * 0.1));
    EXPECT_LT(wrong.plane_rms_m.median, right.plane_rms_m.median) << scale;
    EXPECT_LT(wrong.planar_share, 0.5 * right.planar_share) << scale;
    EXPECT_GT(wrong.bounded_rms_m, 1.1 * right.bounded_rms_m) << scale;
  }
}

// The second of two windows begins with the fifth sweep.
TEST(MapQuality, PlacesAreThoseOfTheFirstSweepOfTheWindow) {
  std::vector<Points> sweeps(13, Points(10, {10, 0, 0}));
  sweeps[0].resize(7);
  sweeps[4].resize(5);
  MapQualityConfig config = every_sweep(9);
  EXPECT_EQ(map_quality(sweeps, std::vector<SE3>(13, SE3::Identity()), config).places, 7U + 5U);
  config.points_per_sweep = 4;
  EXPECT_EQ(map_quality(sweeps, std::vector<SE3>(13, SE3::Identity()), config).places, 4U + 4U);
}

TEST(MapQuality, IsTheNoiseOfThePlanes) {
  for (const double noise_m : {0.005, 0.02}) {
    const Drive drive = floor_and_wall(30, 6000, noise_m);
    const MapQuality quality = map_quality(drive.sweeps, drive.poses);
    EXPECT_GT(quality.plane_rms_m.count, 2500U);
    EXPECT_NEAR(quality.plane_rms_m.median, noise_m, 0.02 * noise_m);
    EXPECT_NEAR(quality.plane_rms_m.mean, noise_m, 0.02 * noise_m);
    EXPECT_GT(quality.plane_rms_p75_m, quality.plane_rms_m.median);
  }
}

TEST(MapQuality, PerfectPlanesHaveAFiniteFigure) {
  Drive drive = floor_and_wall(30, 3000, 0.0);
  for (Points& sweep : drive.sweeps) {
    for (Eigen::Vector3f& p : sweep) p.z() = -1.5F;
  }
  drive.poses.assign(30, SE3::Identity());
  const MapQuality quality = map_quality(drive.sweeps, drive.poses);
  EXPECT_NEAR(quality.plane_rms_m.median, 1e-6, 1e-9);
  EXPECT_TRUE(std::isfinite(quality.mean_map_entropy.value()));
}

TEST(MapQuality, WrongPosesAreWorse) {
  const Drive drive = floor_and_wall(45, 4000, 0.01);
  std::mt19937 random(5);
  MapQuality before = map_quality(drive.sweeps, drive.poses);
  for (const double error : {0.001, 0.003, 0.01}) {
    const std::vector<SE3> wrong = with_drift(random, drive.poses, error / 10, error);
    const MapQuality after = map_quality(drive.sweeps, wrong);
    EXPECT_GT(after.plane_rms_m.median, before.plane_rms_m.median) << error;
    EXPECT_GT(after.plane_rms_m.mean, before.plane_rms_m.mean) << error;
    EXPECT_GT(after.bounded_rms_m, before.bounded_rms_m) << error;
    EXPECT_GT(after.mean_map_entropy.value(), before.mean_map_entropy.value()) << error;
    before = after;
  }
}

TEST(MapQuality, SameBitsForAnyNumberOfThreads) {
  const Drive drive = floor_and_wall(45, 5000, 0.01);
  MapQualityConfig config;
  config.samples_per_window = 500;
  config.points_per_sweep = 4000;
  config.threads = 1;
  const MapQuality one = map_quality(drive.sweeps, drive.poses, config);
  EXPECT_EQ(one.windows, 2U);
  EXPECT_LE(one.places, 1000U);
  for (const int threads : {2, 5, 0}) {
    config.threads = threads;
    expect_same(map_quality(drive.sweeps, drive.poses, config), one);
  }
  config.seed = 2;
  const MapQuality other = map_quality(drive.sweeps, drive.poses, config);
  EXPECT_NE(other.plane_rms_m.median, one.plane_rms_m.median);
  EXPECT_NEAR(other.plane_rms_m.median, one.plane_rms_m.median, 0.03 * one.plane_rms_m.median);
}

TEST(MapQuality, DoesNotDependOnTheFrameOfTheTrajectory) {
  const Drive drive = floor_and_wall(30, 3000, 0.01);
  std::vector<SE3> moved = drive.poses;
  for (SE3& T : moved) T = pose(1000, -2000, 30, 2.0) * T;
  const MapQuality a = map_quality(drive.sweeps, drive.poses);
  const MapQuality b = map_quality(drive.sweeps, moved);
  EXPECT_NEAR(a.plane_rms_m.median, b.plane_rms_m.median, 1e-9);
  EXPECT_NEAR(a.mean_map_entropy.value(), b.mean_map_entropy.value(), 1e-6);
}

TEST(MapQuality, WindowsOverlapByHalf) {
  const Drive drive = floor_and_wall(50, 50, 0.01);
  const auto windows = [&](std::size_t sweeps, std::size_t window) {
    return map_quality({drive.sweeps.begin(), drive.sweeps.begin() + static_cast<std::ptrdiff_t>(sweeps)},
                       {drive.poses.begin(), drive.poses.begin() + static_cast<std::ptrdiff_t>(sweeps)},
                       every_sweep(window))
        .windows;
  };
  EXPECT_EQ(windows(29, 30), 0U);
  EXPECT_EQ(windows(30, 30), 1U);
  EXPECT_EQ(windows(44, 30), 1U);
  EXPECT_EQ(windows(45, 30), 2U);
  EXPECT_EQ(windows(50, 7), 15U);  // begin at 0, 3, … 42
}

}  // namespace
}  // namespace rilo::test
