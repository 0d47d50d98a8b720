// Eigen-decomposition of symmetric 3×3 matrices and the voxel lattice.
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/symmetric_eigen.hpp"
#include "geometry/voxel_key.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {
namespace {

constexpr double kPrecision = 1e-7;  // of the largest eigenvalue

Eigen::Matrix3d compose(const Eigen::Vector3d& values, const Eigen::Vector3d& turn) {
  const Eigen::Matrix3d R = so3_exp(turn);
  const Eigen::Matrix3d A = R * values.asDiagonal() * R.transpose();
  return 0.5 * (A + A.transpose());
}

void expect_decomposition(const Eigen::Matrix3d& A) {
  const SymmetricEigen3 e = symmetric_eigen(A);
  const double scale = A.cwiseAbs().maxCoeff();
  const double tolerance = kPrecision * scale;
  ASSERT_TRUE(e.values.allFinite() && e.vectors.allFinite()) << A;
  EXPECT_LE(e.values[0], e.values[1]);
  EXPECT_LE(e.values[1], e.values[2]);
  const Eigen::Matrix3d gram = e.vectors.transpose() * e.vectors;
  EXPECT_LT((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6) << A;
  EXPECT_LE((A * e.vectors - e.vectors * e.values.asDiagonal()).cwiseAbs().maxCoeff(), tolerance) << A;
}

TEST(SymmetricEigenTest, DiagonalMatrixByHand) {
  const SymmetricEigen3 e = symmetric_eigen(Eigen::Vector3d(3.0, 1.0, 2.0).asDiagonal());
  EXPECT_TRUE(e.values.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-14));
  EXPECT_NEAR(std::abs(e.vectors(1, 0)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(e.vectors(2, 1)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(e.vectors(0, 2)), 1.0, 1e-12);
}

TEST(SymmetricEigenTest, RandomMatrices) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d B = Eigen::Matrix3d::NullaryExpr([&] { return normal(rng); });
    expect_decomposition(B + B.transpose());
    expect_decomposition(B * B.transpose());
  }
}

TEST(SymmetricEigenTest, SpecialSpectraAtAllScales) {
  const std::vector<Eigen::Vector3d> spectra = {{0.0, 0.0, 1.0},        {0.0, 1.0, 1.0}, {1.0, 1.0, 1.0},
                                                {1.0, 1.0, 2.0},        {1.0, 2.0, 2.0}, {0.0, 1e-6, 1.0},
                                                {1e-9, 1.0, 1.0 + 1e-9}};
  std::mt19937 rng(4);
  std::normal_distribution<double> normal;
  for (const double scale : {1e-8, 1e-4, 1.0, 1e4, 1e8}) {
    for (const Eigen::Vector3d& values : spectra) {
      for (int i = 0; i < 50; ++i) {
        const Eigen::Matrix3d A = compose(scale * values, {normal(rng), normal(rng), normal(rng)});
        SCOPED_TRACE(testing::Message() << "scale " << scale << " spectrum " << values.transpose());
        expect_decomposition(A);
        EXPECT_LT((symmetric_eigen(A).values - scale * values).cwiseAbs().maxCoeff(), kPrecision * scale);
      }
    }
  }
}

TEST(SymmetricEigenTest, ZeroMatrixHasAnOrthonormalBasis) { expect_decomposition(Eigen::Matrix3d::Zero()); }

TEST(SymmetricEigenTest, OnlyTheLowerTriangleIsRead) {
  Eigen::Matrix3d A = compose({1.0, 2.0, 5.0}, {0.3, -0.2, 0.9});
  const SymmetricEigen3 e = symmetric_eigen(A);
  A.triangularView<Eigen::StrictlyUpper>().setConstant(99.0);
  EXPECT_EQ(symmetric_eigen(A).values, e.values);
}

TEST(VoxelTest, BoundariesBelongToTheUpperVoxel) {
  const auto x_of = [](double x) { return voxel_of(Eigen::Vector3d(x, 0.0, 0.0), 4.0).x; };
  EXPECT_EQ(x_of(0.0), 0);
  EXPECT_EQ(x_of(-0.0), 0);
  EXPECT_EQ(x_of(0.25), 1);
  EXPECT_EQ(x_of(std::nextafter(0.25, 0.0)), 0);
  EXPECT_EQ(x_of(-0.25), -1);
  EXPECT_EQ(x_of(std::nextafter(-0.25, -1.0)), -2);
  EXPECT_EQ(x_of(-1e-12), -1);
}

TEST(VoxelTest, AgreesWithFloor) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> uniform(-500.0, 500.0);
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d p(uniform(rng), uniform(rng), uniform(rng));
    const VoxelIndex v = voxel_of(p, 1.0 / 0.3);
    EXPECT_EQ(v.x, static_cast<int>(std::floor(p.x() * (1.0 / 0.3))));
    EXPECT_EQ(v.y, static_cast<int>(std::floor(p.y() * (1.0 / 0.3))));
    EXPECT_EQ(v.z, static_cast<int>(std::floor(p.z() * (1.0 / 0.3))));
  }
}

TEST(VoxelTest, KeysAreUniqueUpToTheLimits) {
  const std::vector<int> coordinates = {-(1 << 20), -(1 << 20) + 1, -1000, -2, -1, 0, 1, 2, 1000, (1 << 20) - 1};
  std::set<std::uint64_t> keys;
  std::set<std::uint64_t> mixed;
  for (const int x : coordinates) {
    for (const int y : coordinates) {
      for (const int z : coordinates) {
        keys.insert(voxel_key({x, y, z}));
        mixed.insert(mix_key(voxel_key({x, y, z})));
      }
    }
  }
  EXPECT_EQ(keys.size(), 1000U);
  EXPECT_EQ(mixed.size(), 1000U);  // mixing is one-to-one
}

TEST(VoxelTest, KeyByHand) {
  EXPECT_EQ(voxel_key({1, 2, 3}), 1U | (2ULL << 21U) | (3ULL << 42U));
  EXPECT_EQ(voxel_key({-1, -1, -1}), (1ULL << 63U) - 1U);
}

TEST(VoxelTest, AKeyMeansTheVoxelNearestToThePlace) {
  constexpr int kRound = 1 << 21;
  const auto back = [](const VoxelIndex& v, const VoxelIndex& place) { return voxel_of_key(voxel_key(v), place); };
  for (const int far : {0, kRound, -3 * kRound, 1000 * kRound + 12345, -(1 << 30)}) {
    const VoxelIndex place{far, -far, far / 2};
    for (const int off : {0, 1, -1, 5000, (1 << 20) - 1, -(1 << 20)}) {
      const VoxelIndex v{place.x + off, place.y - off / 2, place.z + off / 3};
      const VoxelIndex found = back(v, place);
      EXPECT_EQ(found.x, v.x);
      EXPECT_EQ(found.y, v.y);
      EXPECT_EQ(found.z, v.z);
    }
  }
  EXPECT_EQ(back({kRound + 7, 0, 0}, {0, 0, 0}).x, 7);
}

}  // namespace
}  // namespace rilo
