// Which returns stand alone, and when they are dropped.
#include "cloud/isolated_returns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cloud/preprocess.hpp"

namespace rilo {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// What 16 beams with 1800 columns see of a box around them.
struct Scan {
  Points points;
  std::vector<bool> flake;
};

Scan scan_of_room(double flake_share, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::exponential_distribution<double> beyond(0.2);
  std::normal_distribution<double> noise(0.0, 0.02);
  Scan scan;
  for (int column = 0; column < 1800; ++column) {
    for (int beam = 0; beam < 16; ++beam) {
      const double azimuth = std::numbers::pi * column / 900.0;
      const double elevation = (2.0 * beam - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      const Eigen::Vector3d to_wall = Eigen::Vector3d(12.0, 9.0, 2.0).cwiseQuotient(d.cwiseAbs());
      const double wall_m = to_wall.minCoeff() + noise(rng);
      const double flake_m = unit(rng) < flake_share ? 0.8 + beyond(rng) : std::numeric_limits<double>::infinity();
      scan.flake.push_back(flake_m < wall_m);
      scan.points.emplace_back((std::min(wall_m, flake_m) * d).cast<float>());
    }
  }
  return scan;
}

std::vector<std::uint8_t> all_valid(const Points& points) { return std::vector<std::uint8_t>(points.size(), 1); }

double share_of(const Points& points) {
  IsolatedReturns returns;
  return returns.find(points, all_valid(points)).value();
}

bool too_sparse(const Points& points) {
  IsolatedReturns returns;
  EXPECT_FALSE(returns.more_than(0.0, points, all_valid(points)));
  return !returns.find(points, all_valid(points)).has_value();
}

TEST(IsolatedReturns, FewOfSurfaces) { EXPECT_LT(share_of(scan_of_room(0.0).points), 0.03); }

TEST(IsolatedReturns, MostFlakesAndFewOfTheWalls) {
  for (const double flake_share : {0.3, 0.6}) {
    const Scan scan = scan_of_room(flake_share);
    IsolatedReturns returns;
    const double share = returns.find(scan.points, all_valid(scan.points)).value();
    double flakes = 0;
    double flakes_found = 0;
    double found = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      flakes += scan.flake[i] ? 1 : 0;
      found += returns.isolated(i) ? 1 : 0;
      flakes_found += returns.isolated(i) && scan.flake[i] ? 1 : 0;
    }
    const auto size = static_cast<double>(scan.points.size());
    EXPECT_GT(flakes_found, 0.8 * flakes) << flake_share;
    EXPECT_LT(found - flakes_found, 0.2 * (size - flakes)) << flake_share;
    EXPECT_NEAR(share, found / size, 1e-9) << flake_share;  // all are within 30 m
  }
}

TEST(IsolatedReturns, TheOrderOfThePointsDoesNotMatter) {
  const Scan scan = scan_of_room(0.4);
  IsolatedReturns returns;
  const double share = returns.find(scan.points, all_valid(scan.points)).value();
  std::vector<bool> before;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    before.push_back(returns.isolated(i));
  }
  Points turned = scan.points;
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(returns.find(turned, all_valid(turned)), share);
  for (std::size_t i = 0; i < turned.size(); ++i) {
    ASSERT_EQ(returns.isolated(i), before[turned.size() - 1 - i]);
  }
}

TEST(IsolatedReturns, AQuarterOfThePointsShowsClearAir) {
  for (const double flake_share : {0.0, 0.05, 0.1, 0.3, 0.6}) {
    for (const bool by_beam : {false, true}) {
      const Scan scan = scan_of_room(flake_share, 5);
      Points points;
      for (std::size_t beam = 0; beam < 16; ++beam) {
        for (std::size_t column = 0; column < 1800; ++column) {
          points.push_back(scan.points[by_beam ? column * 16 + beam : points.size()]);
        }
      }
      IsolatedReturns returns;
      const double share = returns.find(points, all_valid(points)).value();
      EXPECT_EQ(returns.more_than(0.2, points, all_valid(points)), share > 0.2) << flake_share << " " << share;
    }
  }
}

TEST(IsolatedReturns, NoneFarAway) {
  Scan scan = scan_of_room(0.0);
  scan.points[7] = 0.4F * scan.points[7];
  scan.points[800] *= 50.0F / scan.points[800].norm();
  IsolatedReturns returns;
  returns.find(scan.points, all_valid(scan.points));
  EXPECT_TRUE(returns.isolated(7));
  EXPECT_FALSE(returns.isolated(800));
}

TEST(IsolatedReturns, PointsThatAreNotValidDoNotCount) {
  Scan scan = scan_of_room(0.3);
  IsolatedReturns returns;
  const Points clean = scan.points;
  const double share = returns.find(clean, all_valid(clean)).value();
  Points dirty = clean;
  std::vector<std::uint8_t> valid = all_valid(clean);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.0F, 3e38F, -1e-40F}) {
    for (int i = 0; i < 500; ++i) {
      dirty.emplace_back(bad, 1.0F, bad);
      dirty.emplace_back(bad, bad, bad);
      dirty.emplace_back(clean.front());
      valid.insert(valid.end(), 3, 0);
    }
  }
  EXPECT_EQ(returns.find(dirty, valid), share);
  EXPECT_FALSE(returns.isolated(dirty.size() - 1));
}

TEST(IsolatedReturns, SparseCloudsSayNothing) {
  EXPECT_TRUE(too_sparse({}));
  EXPECT_TRUE(too_sparse({{3, 1, 1}}));
  Points line;
  for (int i = 1; i < 40; ++i) {
    line.emplace_back(0.3F * static_cast<float>(i), 2.0F, 0.0F);
  }
  EXPECT_TRUE(too_sparse(line));
  std::mt19937 rng(3);
  std::normal_distribution<float> any;
  Points ball;
  for (int i = 0; i < 3000; ++i) {
    ball.emplace_back(10.0F * Eigen::Vector3f(any(rng), any(rng), any(rng)));
  }
  EXPECT_TRUE(too_sparse(ball));
}

TEST(IsolatedReturns, FewerReturnsLargerCells) {
  // Every third column, as of a sensor that turns three times as fast.
  const Scan scan = scan_of_room(0.0);
  Points third;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i / 16 % 3 == 0) {
      third.push_back(scan.points[i]);
    }
  }
  EXPECT_LT(share_of(third), 0.05);
}

TEST(IsolatedReturns, ManyReturnsOfOnePlaceAreNotIsolated) { EXPECT_EQ(share_of(Points(5000, {1, 2, 3})), 0.0); }

/// Flakes at the beginning of the sweep, at intensity 1; walls at its end, at 2.
Sweep sweep_of(const Scan& scan) {
  Sweep sweep;
  sweep.points = scan.points;
  for (const bool flake : scan.flake) {
    sweep.times_s.push_back(flake ? 0.0F : 0.1F);
    sweep.intensities.push_back(flake ? 1.0F : 2.0F);
  }
  return sweep;
}

TEST(PreprocessTest, FlakesAreDroppedWhenItSnows) {
  const Scan scan = scan_of_room(0.5);
  const Sweep sweep = sweep_of(scan);
  const auto walls_in = static_cast<double>(std::count(scan.flake.begin(), scan.flake.end(), false));
  PreprocessConfig config;
  Preprocessor preprocessor{config};
  preprocessor.keep_intensities(true);
  const PreparedSweep& prepared = preprocessor.prepare(sweep);
  EXPECT_NEAR(static_cast<double>(prepared.valid_points), walls_in, 0.1 * walls_in);
  EXPECT_EQ(prepared.flakes + prepared.valid_points, sweep.points.size());
  EXPECT_DOUBLE_EQ(prepared.kept_share() * static_cast<double>(sweep.points.size()),
                   static_cast<double>(prepared.valid_points));
  // What is left keeps its own time and intensity.
  double walls = 0;
  for (std::size_t i = 0; i < prepared.map_cloud.size(); ++i) {
    const bool wall = prepared.map_cloud.intensities[i] == 2.0F;
    if (wall) {
      EXPECT_FLOAT_EQ(prepared.map_cloud.offsets_s[i], 0.05F);
    }
    walls += wall ? static_cast<double>(prepared.map_cloud.counts[i]) : 0.0;
  }
  EXPECT_GT(walls, 0.75 * static_cast<double>(prepared.valid_points));

  config.most_isolated = 1.0;
  Preprocessor keeps_all{config};
  EXPECT_EQ(keeps_all.prepare(sweep).valid_points, sweep.points.size());
  EXPECT_EQ(keeps_all.prepare(sweep).kept_share(), 1.0);
}

TEST(PreprocessTest, AFewFlakesAreKept) {
  const Sweep sweep = sweep_of(scan_of_room(0.1));
  Preprocessor preprocessor{PreprocessConfig{}};
  EXPECT_EQ(preprocessor.prepare(sweep).valid_points, sweep.points.size());
  EXPECT_EQ(preprocessor.prepare(sweep).kept_share(), 1.0);
}

}  // namespace
}  // namespace rilo
