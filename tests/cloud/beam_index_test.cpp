// Which beam a point came from: sweeps in the order of the beams, of the firings, with rings, and hostile ones.
#include "cloud/beam_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "cloud/beam_angles.hpp"
#include "geometry/degrees.hpp"

namespace rilo {
namespace {

constexpr int kRows = 32;
constexpr int kColumns = 360;

double elevation_deg(int row) { return 2.0 - 0.8 * row; }

Eigen::Vector3f point_at(double azimuth_deg, double elevation, double range_m) {
  const double a = azimuth_deg * kRadPerDeg;
  const double e = elevation * kRadPerDeg;
  return (range_m * Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))).cast<float>();
}

struct Labelled {
  Sweep sweep;
  std::vector<int> rows;
};

/// Row by row, each from `start_deg` on in the sense of `direction`; `shift` moves the points as motion compensation
/// does.
Labelled row_by_row(double start_deg, double direction, const Eigen::Vector3f& shift = Eigen::Vector3f::Zero()) {
  Labelled out;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double share = static_cast<double>(column) / kColumns;
      out.sweep.points.push_back(point_at(start_deg + direction * 360.0 * share, elevation_deg(row), 20.0 + row % 3) +
                                 static_cast<float>(share - 0.5) * shift);
      out.rows.push_back(row);
    }
  }
  return out;
}

/// Share of the points whose index is the one that most points of their row have; 0 when two rows share theirs.
double right_share(const Labelled& in) {
  std::vector<Beam> beams;
  BeamIndex().assign(in.sweep, beams);
  std::map<int, std::map<Beam, int>> counts;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams[i] != kNoBeam) {
      ++counts[in.rows[i]][beams[i]];
    }
  }
  std::set<Beam> indices;
  int right = 0;
  for (const auto& [row, of_row] : counts) {
    const auto most = std::max_element(of_row.begin(), of_row.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (!indices.insert(most->first).second) {
      return 0.0;
    }
    right += most->second;
  }
  return static_cast<double>(right) / static_cast<double>(beams.size());
}

TEST(BeamIndex, BeamByBeamInEitherSenseFromAnyAzimuth) {
  for (const double start : {0.0, 95.0, 180.0, -30.0}) {
    EXPECT_GT(right_share(row_by_row(start, 1.0)), 0.985) << start;
    EXPECT_GT(right_share(row_by_row(start, -1.0)), 0.985) << start;
  }
}

TEST(BeamIndex, MotionCompensationDoesNotMixTheBeams) {
  // 2 m during the sweep: the elevation of single points moves by more than the beams are apart.
  for (const double direction : {1.0, -1.0}) {
    EXPECT_GT(right_share(row_by_row(0.0, direction, {2.0F, 0.5F, 0.0F})), 0.98) << direction;
  }
}

TEST(BeamIndex, PointsThatComeBackOverABorderDoNotMixTheBeams) {
  Labelled in = row_by_row(0.0, 1.0, {2.0F, 0.5F, 0.0F});
  for (std::size_t i = 2; i + 1 < in.rows.size(); i += 3) {  // those beside each border, too
    if (in.rows[i] == in.rows[i + 1]) {
      std::swap(in.sweep.points[i], in.sweep.points[i + 1]);
    }
  }
  EXPECT_GT(right_share(in), 0.97);
}

TEST(BeamIndex, MissingReturnsDoNotMixTheBeams) {
  Labelled in = row_by_row(0.0, 1.0);
  Labelled out;
  std::mt19937 rng(3);
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    const bool gap = i % kColumns > 50 && i % kColumns < 200 && in.rows[i] % 4 == 0;
    if (!gap && rng() % 4 != 0) {
      out.sweep.points.push_back(in.sweep.points[i]);
      out.rows.push_back(in.rows[i]);
    }
  }
  EXPECT_GT(right_share(out), 0.98);
}

TEST(BeamIndex, FiringByFiringTheAngleOfEachPointCounts) {
  Labelled in = row_by_row(0.0, 1.0);
  Labelled out;
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      out.sweep.points.push_back(in.sweep.points[static_cast<std::size_t>(row * kColumns + column)]);
      out.rows.push_back(row);
    }
  }
  EXPECT_GT(right_share(out), 0.5);  // a beam on a border has two indices
  std::vector<Beam> beams;
  BeamIndex().assign(out.sweep, beams);
  std::map<Beam, std::set<int>> rows;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    rows[beams[i]].insert(out.rows[i]);
  }
  for (const auto& [beam, of_beam] : rows) {
    EXPECT_EQ(of_beam.size(), 1U) << beam;  // but no index has two beams
  }
}

TEST(BeamIndex, RingsAreTakenAsTheyAre) {
  Labelled in = row_by_row(0.0, 1.0);
  for (std::size_t i = 0; i < in.rows.size(); ++i) {
    in.sweep.rings.push_back(static_cast<std::uint16_t>(31 - in.rows[i]));
  }
  in.sweep.rings.front() = 60000;
  std::vector<Beam> beams;
  BeamIndex().assign(in.sweep, beams);
  EXPECT_EQ(beams.front(), kNoBeam);
  EXPECT_EQ(beams[1], 31);
  EXPECT_EQ(beams.back(), 0);
}

TEST(BeamIndex, HostileSweeps) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<Beam> beams;
  BeamIndex index;
  index.assign({}, beams);
  EXPECT_TRUE(beams.empty());
  Sweep sweep;
  sweep.points = {{nan, 0, 0}, {0, 0, 0}, {0, 0, 5}, {inf, 1, 1}, {1, 0, 1e30F}, {10, 0, -1}};
  index.assign(sweep, beams);
  ASSERT_EQ(beams.size(), 6U);
  EXPECT_EQ(beams[0], kNoBeam);
  EXPECT_EQ(beams[1], kNoBeam);
  EXPECT_EQ(beams[2], kNoBeam);
  EXPECT_EQ(beams[4], kNoBeam);
  EXPECT_NE(beams[5], kNoBeam);
  Labelled in = row_by_row(0.0, 1.0);
  for (std::size_t i = 0; i < in.rows.size(); i += 7) {
    in.sweep.points[i].x() = nan;
  }
  EXPECT_GT(right_share(in), 0.8);
  std::shuffle(in.sweep.points.begin(), in.sweep.points.end(), std::mt19937(1));
  index.assign(in.sweep, beams);
  EXPECT_EQ(beams.size(), in.sweep.points.size());
}

TEST(BeamAngles, CorrectsAlongTheTangents) {
  BeamAngles angles;
  angles.at(7) = {0.001F, -0.002F};
  const Eigen::Vector3f p = point_at(40.0, -5.0, 30.0);
  const Eigen::Vector3f expected = point_at(40.0 - 0.002 / kRadPerDeg, -5.0 + 0.001 / kRadPerDeg, 30.0);
  EXPECT_LT((angles.corrected(p, 7) - expected).norm(), 5e-4F);
  EXPECT_EQ(angles.corrected(p, 8), p);
  EXPECT_EQ(angles.corrected(p, kNoBeam), p);
}

}  // namespace
}  // namespace rilo
