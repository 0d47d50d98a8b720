// Density filter, covariances, degeneracy and map score: cases that can be worked out by hand.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "registration/covariances.hpp"
#include "registration/deadline.hpp"
#include "registration/degeneracy.hpp"
#include "registration/density_filter.hpp"
#include "registration/map_score.hpp"
#include "registration/normal_equations.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

PointGrid grid_of(const std::vector<Eigen::Vector3f>& points, double cell_m = 1.0) {
  PointGrid grid(cell_m);
  grid.build(points);
  return grid;
}

TEST(Density, CountsNeighboursAndThePointItself) {
  const PointGrid grid = grid_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {10, 0, 0}});
  EXPECT_EQ(point_densities(grid, 1.5), (std::vector<std::uint32_t>{2, 3, 2, 1}));
  EXPECT_EQ(point_densities(grid, 0.5), (std::vector<std::uint32_t>{1, 1, 1, 1}));
  EXPECT_EQ(point_densities(grid, 100.0), (std::vector<std::uint32_t>{4, 4, 4, 4}));
  EXPECT_TRUE(point_densities(grid_of({}), 1.0).empty());
}

TEST(Density, PercentileIsTheSmallestValueWithThatShareAtOrBelowIt) {
  const std::vector<std::uint32_t> densities{5, 1, 3, 2, 4};
  EXPECT_EQ(density_threshold(densities, 0.0), 0U);
  EXPECT_EQ(density_threshold(densities, -3.0), 0U);
  EXPECT_EQ(density_threshold(densities, 1e-6), 1U);
  EXPECT_EQ(density_threshold(densities, 19.0), 1U);
  EXPECT_EQ(density_threshold(densities, 21.0), 2U);
  EXPECT_EQ(density_threshold(densities, 50.0), 3U);
  EXPECT_EQ(density_threshold(densities, 100.0), 5U);
  EXPECT_EQ(density_threshold(densities, 250.0), 5U);
  EXPECT_EQ(density_threshold({}, 50.0), 0U);
  EXPECT_EQ(density_threshold({7}, 1.0), 7U);
}

TEST(Density, FilterDropsWhatIsBelowTheThresholdAndKeepsTheOrder) {
  const std::vector<Eigen::Vector3f> points{{10, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const PointGrid grid = grid_of(points);
  EXPECT_EQ(density_filter(grid, 1.5, 0.0), points);
  EXPECT_EQ(density_filter(grid, 1.5, 25.0), points);  // threshold 1: nothing is below it
  EXPECT_EQ(density_filter(grid, 1.5, 30.0), (std::vector<Eigen::Vector3f>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(density_filter(grid, 1.5, 100.0), (std::vector<Eigen::Vector3f>{{1, 0, 0}}));
  EXPECT_TRUE(density_filter(grid_of({}), 1.5, 50.0).empty());
}

TEST(Covariances, OfAPlaneAndOfALine) {
  std::vector<Eigen::Vector3f> plane;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      plane.emplace_back(static_cast<float>(x), static_cast<float>(y), 5.0F);
    }
  }
  const auto of_plane = point_covariances(grid_of(plane), 9, 10.0);
  ASSERT_EQ(of_plane.size(), plane.size());
  Eigen::Matrix3f expected = Eigen::Matrix3f::Zero();
  expected.diagonal() << 2.0F / 3.0F, 2.0F / 3.0F, 0.0F;
  for (const Eigen::Matrix3f& C : of_plane) {
    EXPECT_TRUE(C.isApprox(expected, 1e-5F)) << C;
  }
  const PointGrid line = grid_of({{-2, 0, 0}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const Eigen::Matrix3f C = point_covariances(line, 5, 10.0)[2];
  EXPECT_NEAR(C(0, 0), 2.0F, 1e-5F);
  EXPECT_NEAR(C.norm(), 2.0F, 1e-5F);
}

TEST(Covariances, FewNeighboursSayNothing) {
  const std::vector<Eigen::Vector3f> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {100, 0, 0}};
  for (const Eigen::Matrix3f& C : point_covariances(grid_of(points), 10, 5.0)) {
    EXPECT_EQ(C, Eigen::Matrix3f::Zero());
  }
  for (const Eigen::Matrix3f& C : point_covariances(grid_of(points), 3, 1000.0)) {
    EXPECT_EQ(C, Eigen::Matrix3f::Zero());
  }
  EXPECT_TRUE(point_covariances(grid_of({}), 10, 5.0).empty());
}

/// Point-to-plane Hessian of points with known normals.
Matrix6d hessian_of(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& normals) {
  NormalEquations sums;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector6d J;
    J << points[i].cross(normals[i]), normals[i];
    sums.add(J, 0.0, 1.0);
  }
  return sums.pose_hessian();
}

/// Lattices of 9×9 points on planes through `normal * 3`.
Matrix6d hessian_of_planes(const std::vector<Eigen::Vector3d>& outward, double half_length = 4.0) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (const Eigen::Vector3d& n : outward) {
    const Eigen::Vector3d a = n.unitOrthogonal();
    const Eigen::Vector3d b = n.cross(a);
    for (int u = -4; u <= 4; ++u) {
      for (int v = -4; v <= 4; ++v) {
        points.emplace_back(3.0 * n + half_length / 4.0 * (u * a + v * b));
        normals.push_back(n);
      }
    }
  }
  return hessian_of(points, normals);
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

TEST(Degeneracy, APlaneLeavesThreeDirectionsACorridorOneARoomNone) {
  const PoseDegeneracy plane = analyse_degeneracy(hessian_of_planes({-kZ}));
  EXPECT_LT(plane.relative_eigenvalues[2], 1e-9);
  EXPECT_GT(plane.relative_eigenvalues[3], 0.1);
  const PoseDegeneracy corridor = analyse_degeneracy(hessian_of_planes({-kZ, kY, -kY}));
  EXPECT_LT(corridor.relative_eigenvalues[0], 1e-9);
  EXPECT_GT(corridor.relative_eigenvalues[1], 1e-3);
  EXPECT_NEAR(std::abs(corridor.directions(3, 0)), 1.0, 1e-6);  // x is what it cannot see
  const PoseDegeneracy room = analyse_degeneracy(hessian_of_planes({kX, -kX, kY, -kY, kZ, -kZ}));
  EXPECT_GT(room.relative_eigenvalues[0], 0.1);
  for (const PoseDegeneracy& d : {plane, corridor, room}) {
    EXPECT_DOUBLE_EQ(d.relative_eigenvalues[5], 1.0);
    EXPECT_TRUE(std::is_sorted(d.relative_eigenvalues.begin(), d.relative_eigenvalues.end()));
    EXPECT_GE(d.relative_eigenvalues[0], 0.0);
    EXPECT_TRUE((d.directions.transpose() * d.directions).isIdentity(1e-9));
  }
}

TEST(Degeneracy, TheLeverMakesItIndependentOfScaleAndWeight) {
  const Matrix6d H = hessian_of_planes({kX, -kX, kY, -kZ});
  Matrix6d larger = 7.0 * H;  // seven times the points, in a place three times as large
  larger.topLeftCorner<3, 3>() *= 9.0;
  larger.topRightCorner<3, 3>() *= 3.0;
  larger.bottomLeftCorner<3, 3>() *= 3.0;
  const PoseDegeneracy small = analyse_degeneracy(H);
  const PoseDegeneracy large = analyse_degeneracy(larger);
  EXPECT_NEAR(large.lever_arm_m, 3.0 * small.lever_arm_m, 1e-9);
  EXPECT_TRUE(large.relative_eigenvalues.isApprox(small.relative_eigenvalues, 1e-9));
}

/// Information about a sensor that sits at `offset` from where `H` is about, with the same axes.
Matrix6d seen_from(const Eigen::Vector3d& offset, const Matrix6d& H) {
  const Matrix6d S = adjoint(SE3(Eigen::Translation3d(offset)));
  return S.transpose() * H * S;
}

TEST(Degeneracy, DoesNotDependOnWhereTheSensorSits) {
  const Matrix6d H = hessian_of_planes({kX, -kX, kY, -kZ}) + 0.1 * hessian_of_planes({kX, kY, kZ}, 9.0);
  const Matrix6d noise = 1e-3 * hessian_of_planes({kY, kZ});
  const Eigen::Vector3d offset(-30.0, 4.0, 1.0);  // it looks at the same planes from afar
  const PoseDegeneracy within = analyse_degeneracy(H, noise);
  const PoseDegeneracy ahead = analyse_degeneracy(seen_from(offset, H), seen_from(offset, noise));
  EXPECT_NEAR(ahead.lever_arm_m, within.lever_arm_m, 1e-4);
  EXPECT_LT((ahead.centre_m + offset - within.centre_m).norm(), 1e-3);
  EXPECT_TRUE(ahead.relative_eigenvalues.isApprox(within.relative_eigenvalues, 1e-4))
      << ahead.relative_eigenvalues.transpose() << "\n"
      << within.relative_eigenvalues.transpose();
  const double threshold = within.relative_eigenvalues[1];
  const Matrix6d selected = soft_selection(within, threshold).transpose() * H * soft_selection(within, threshold);
  const Matrix6d W = soft_selection(ahead, threshold);
  EXPECT_TRUE((W.transpose() * seen_from(offset, H) * W).isApprox(seen_from(offset, selected), 1e-4));
}

TEST(Degeneracy, TheCentreIsWhereRotationsAreSeenLeast) {
  const Matrix6d H = hessian_of_planes({kX, kY, -kZ}, 2.0);
  const PoseDegeneracy d = analyse_degeneracy(H);
  const auto trace_at = [&](const Eigen::Vector3d& centre) {
    PoseDegeneracy about;
    about.centre_m = centre;
    return (about.to_sensor().transpose() * H * about.to_sensor()).topLeftCorner<3, 3>().trace();
  };
  for (const Eigen::Vector3d& axis : {kX, kY, kZ}) {
    EXPECT_LT(trace_at(d.centre_m), trace_at(d.centre_m + 0.1 * axis));
    EXPECT_LT(trace_at(d.centre_m), trace_at(d.centre_m - 0.1 * axis));
  }
}

TEST(Degeneracy, NoInformationOrNoNumbersGiveZeros) {
  Matrix6d broken = Matrix6d::Identity();
  broken(0, 1) = std::nan("");
  Matrix6d rotation_only = Matrix6d::Zero();
  rotation_only.topLeftCorner<3, 3>().setIdentity();
  for (const Matrix6d& H : {Matrix6d(Matrix6d::Zero()), broken, rotation_only}) {
    const PoseDegeneracy d = analyse_degeneracy(H);
    EXPECT_EQ(d.relative_eigenvalues, Vector6d::Zero());
    EXPECT_TRUE(d.directions.isIdentity());
    EXPECT_TRUE(soft_selection(d, 1e-3).isZero());
    EXPECT_TRUE(soft_selection(d, 0.0).isIdentity());
  }
}

TEST(Degeneracy, WhatIsNoiseDoesNotCount) {
  const Matrix6d H = hessian_of_planes({-kZ, kY, -kY});
  Matrix6d noise = Matrix6d::Zero();
  noise(3, 3) = 0.02 * H(4, 4);  // tilted walls seem to show x
  const PoseDegeneracy fooled = analyse_degeneracy(H + noise);
  EXPECT_GT(fooled.relative_eigenvalues[0], 1e-3);
  const PoseDegeneracy aware = analyse_degeneracy(H + noise, noise);
  EXPECT_LT(aware.relative_eigenvalues[0], 1e-9);
  EXPECT_NEAR(std::abs(aware.directions(3, 0)), 1.0, 1e-6);
  const PoseDegeneracy doubted = analyse_degeneracy(H + noise, 1.5 * noise);
  EXPECT_EQ(doubted.relative_eigenvalues[0], 0.0) << "never negative";
}

TEST(SoftSelection, KeepsTheShareOfEachEigenvalue) {
  const Matrix6d H = hessian_of_planes({kX, kY, -kY, -kZ}, 2.0);
  const PoseDegeneracy d = analyse_degeneracy(H);
  const double threshold = d.relative_eigenvalues[1];
  const Matrix6d W = soft_selection(d, threshold);
  const Matrix6d moves = d.to_sensor() * d.directions;  // of the sensor
  const Matrix6d before = moves.transpose() * H * moves;
  const Matrix6d after = moves.transpose() * W.transpose() * H * W * moves;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double r = std::pow(std::max(0.0, 2.0 * d.relative_eigenvalues[i] / threshold - 1.0), 4);
    EXPECT_NEAR(after(i, i) / before(i, i), r / (1.0 + r), 1e-9) << i;
  }
  EXPECT_NEAR(after(1, 1) / before(1, 1), 0.5, 1e-9);
  const Matrix6d none = soft_selection(d, 2.0 * d.relative_eigenvalues[0]);
  EXPECT_NEAR((none * moves.col(0)).norm(), 0.0, 1e-9) << "half of the threshold";
  EXPECT_TRUE((W.transpose() * H * W).isApprox((W.transpose() * H * W).transpose(), 1e-12));
}

TEST(SoftSelection, OnlyWeakDirectionsFade) {
  const PoseDegeneracy d = analyse_degeneracy(hessian_of_planes({kY, -kY, -kZ}));
  EXPECT_TRUE(soft_selection(d, 0.0).isIdentity());
  EXPECT_TRUE(soft_selection(d, -1.0).isIdentity());
  const Matrix6d W = soft_selection(d, 1e-4);
  EXPECT_NEAR((W * Vector6d::Unit(3)).norm(), 0.0, 1e-6);
  for (const Eigen::Index strong : {0, 1, 2, 4, 5}) {
    EXPECT_TRUE((W * Vector6d::Unit(strong)).isApprox(Vector6d::Unit(strong), 1e-3)) << strong;
  }
}

TEST(MapScore, IsOneOnThePlanesAndFallsWithTheDistance) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  const auto points = test::seen_from(SE3::Identity(), test::rimless_room(0.5, 0.3, 1.5));
  EXPECT_NEAR(map_score(points, map, SE3::Identity(), 0.2), 1.0, 1e-3);
  EXPECT_EQ(map_score({}, map, SE3::Identity(), 0.2), 0.0);
  EXPECT_EQ(map_score(points, LocalMap(LocalMapConfig{}), SE3::Identity(), 0.2), 0.0);
  SE3 far = SE3::Identity();
  far.translation().x() = 500.0;
  EXPECT_EQ(map_score(points, map, far, 0.2), 0.0);
  // One point 0.1 m in front of the floor: exp(−0.1² / 2·0.1²).
  EXPECT_NEAR(map_score({{0.05F, 0.05F, -2.77F}}, map, SE3::Identity(), 0.1), std::exp(-0.5), 1e-3);
  // The same with a point nowhere near a plane: half of it.
  EXPECT_NEAR(map_score({{0.05F, 0.05F, -2.77F}, {0, 0, 0}}, map, SE3::Identity(), 0.1), 0.5 * std::exp(-0.5), 1e-3);
}

TEST(Deadlines, NeverWithoutAClockAndAShareOfTheTimeLeft) {
  EXPECT_FALSE(Deadline().passed());
  EXPECT_FALSE(Deadline().passed_after(1e12));
  EXPECT_FALSE(Deadline().after(0.0).passed());
  std::int64_t now_ns = 0;
  const Deadline::Clock clock = [&] { return now_ns; };
  const Deadline end(clock, 10'000'000);
  EXPECT_FALSE(end.passed());
  EXPECT_FALSE(end.passed_after(9.0));
  EXPECT_TRUE(end.passed_after(10.0));
  const Deadline early = end.after(0.4);
  now_ns = 4'000'000;
  EXPECT_TRUE(early.passed());
  EXPECT_FALSE(end.passed());
}

}  // namespace
}  // namespace rilo
