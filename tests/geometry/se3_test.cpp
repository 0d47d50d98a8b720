// SE(3): exponential, logarithm, adjoint, interpolation.
#include "rilo/geometry/se3.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rilo {
namespace {

constexpr double kPi = std::numbers::pi;

class Se3Test : public testing::Test {
 protected:
  Eigen::Vector3d direction() {
    Eigen::Vector3d v;
    do {
      v = Eigen::Vector3d(unit_(rng_), unit_(rng_), unit_(rng_));
    } while (v.norm() < 0.1);
    return v.normalized();
  }
  Vector6d twist(double angle_rad, double distance_m) {
    Vector6d xi;
    xi << angle_rad * direction(), distance_m * direction();
    return xi;
  }

  std::mt19937 rng_{7};
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
};

/// exp of a 4×4 twist matrix by its power series, after halving it until the series converges fast.
Eigen::Matrix4d series_exp(const Vector6d& xi) {
  constexpr int kHalvings = 8;
  Eigen::Matrix4d X = Eigen::Matrix4d::Zero();
  X.topLeftCorner<3, 3>() = hat(xi.head<3>());
  X.topRightCorner<3, 1>() = xi.tail<3>();
  X /= std::pow(2.0, kHalvings);
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  for (int n = 1; n < 20; ++n) {
    term = (term * X / n).eval();
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) {
    sum = (sum * sum).eval();
  }
  return sum;
}

const std::vector<double>& angles() {
  static const std::vector<double> kList = {0.0,  1e-300, 1e-12, 1e-9, 9e-9, 1e-6,       9.99e-5,    1.001e-4,
                                            1e-3, 0.01,   0.3,   1.0,  2.0,  kPi - 1e-3, kPi - 1e-6, kPi - 1e-9};
  return kList;
}

TEST_F(Se3Test, HatIsTheCrossProduct) {
  const Eigen::Vector3d v(1.0, -2.0, 3.0);
  const Eigen::Vector3d w(0.5, 4.0, -1.0);
  EXPECT_EQ(hat(v) * w, v.cross(w));
  EXPECT_EQ(hat(v).transpose(), -hat(v));
}

TEST_F(Se3Test, ExponentialOfAQuarterTurnByHand) {
  // A quarter turn to the left along a circle of radius 1: one metre forward, one to the left.
  Vector6d xi;
  xi << 0.0, 0.0, kPi / 2, kPi / 2, 0.0, 0.0;
  const SE3 T = se3_exp(xi);
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(1.0, 1.0, 0.0), 1e-14));
  EXPECT_TRUE((T.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
}

TEST_F(Se3Test, ExponentialAgreesWithTheSeries) {
  for (const double angle : angles()) {
    for (int i = 0; i < 20; ++i) {
      const Vector6d xi = twist(angle, 10.0);
      EXPECT_LT((se3_exp(xi).matrix() - series_exp(xi)).cwiseAbs().maxCoeff(), 1e-10) << "angle " << angle;
    }
  }
}

TEST_F(Se3Test, ExponentialAgreesWithTheSeriesBeyondOneTurn) {
  for (const double angle : {kPi, 4.0, 2.0 * kPi, 9.0}) {
    const Vector6d xi = twist(angle, 3.0);
    EXPECT_LT((se3_exp(xi).matrix() - series_exp(xi)).cwiseAbs().maxCoeff(), 1e-10) << "angle " << angle;
  }
}

TEST_F(Se3Test, LogarithmUndoesTheExponential) {
  for (const double angle : angles()) {
    for (int i = 0; i < 20; ++i) {
      const Vector6d xi = twist(angle, 10.0);
      const Vector6d back = se3_log(se3_exp(xi));
      EXPECT_LT((back - xi).cwiseAbs().maxCoeff(), 1e-9) << "angle " << angle;
    }
  }
}

TEST_F(Se3Test, SmallRotationsKeepTheirRelativePrecision) {
  for (const double angle : {1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3}) {
    const Eigen::Vector3d phi = angle * direction();
    EXPECT_LT((so3_log(so3_exp(phi)) - phi).norm(), 1e-9 * angle + 1e-16) << "angle " << angle;
  }
}

TEST_F(Se3Test, ExponentialUndoesTheLogarithmAroundPi) {
  for (const double past : {-1e-3, -1e-8, 0.0, 1e-8, 1e-3}) {
    for (int i = 0; i < 50; ++i) {
      const SE3 T = se3_exp(twist(kPi + past, 5.0));
      const Vector6d xi = se3_log(T);
      EXPECT_LE(xi.head<3>().norm(), kPi + 1e-12);
      EXPECT_LT((se3_exp(xi).matrix() - T.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST_F(Se3Test, HalfTurnsAboutTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d R = -Eigen::Matrix3d::Identity();
    R(axis, axis) = 1.0;
    const Eigen::Vector3d phi = so3_log(R);
    EXPECT_NEAR(phi.norm(), kPi, 1e-14);
    EXPECT_NEAR(std::abs(phi[axis]), kPi, 1e-14);
    EXPECT_LT((so3_exp(phi) - R).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST_F(Se3Test, IdentityHasAZeroLogarithm) {
  EXPECT_EQ(se3_log(SE3::Identity()), Vector6d::Zero());
  EXPECT_EQ(se3_exp(Vector6d::Zero()).matrix(), Eigen::Matrix4d::Identity());
}

TEST_F(Se3Test, AdjointMovesATwistThroughAPose) {
  for (int i = 0; i < 100; ++i) {
    const SE3 T = se3_exp(twist(2.0 * unit_(rng_), 5.0));
    const Vector6d xi = twist(1.0, 2.0);
    const SE3 left = se3_exp(adjoint(T) * xi);
    const SE3 right = T * se3_exp(xi) * T.inverse();
    EXPECT_LT((left.matrix() - right.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_F(Se3Test, AdjointOfAProductIsTheProduct) {
  const SE3 A = se3_exp(twist(1.1, 5.0));
  const SE3 B = se3_exp(twist(0.4, 2.0));
  EXPECT_TRUE(adjoint(A * B).isApprox(adjoint(A) * adjoint(B), 1e-13));
}

TEST_F(Se3Test, InterpolationRunsAlongTheGeodesic) {
  const SE3 a = se3_exp(twist(1.0, 20.0));
  const Vector6d xi = twist(1.5, 3.0);
  const SE3 b = a * se3_exp(xi);
  EXPECT_TRUE(interpolate(a, b, 0.0).isApprox(a, 1e-14));
  EXPECT_TRUE(interpolate(a, b, 1.0).isApprox(b, 1e-12));
  for (const double s : {-0.7, 0.25, 0.5, 1.8}) {
    EXPECT_TRUE(interpolate(a, b, s).isApprox(a * se3_exp(s * xi), 1e-12)) << "s " << s;
  }
}

TEST_F(Se3Test, RenormalisedIsOrthonormalAndNear) {
  for (int i = 0; i < 50; ++i) {
    SE3 T = se3_exp(twist(3.0 * unit_(rng_), 5.0));
    const SE3 clean = T;
    T.linear() += 1e-4 * Eigen::Matrix3d::NullaryExpr([&] { return unit_(rng_); });
    const SE3 fixed = renormalised(T);
    const Eigen::Matrix3d gram = fixed.linear() * fixed.linear().transpose();
    EXPECT_LT((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_NEAR(fixed.linear().determinant(), 1.0, 1e-14);
    EXPECT_LT((fixed.linear() - clean.linear()).cwiseAbs().maxCoeff(), 4e-4);
    EXPECT_EQ(fixed.translation(), T.translation());
  }
}

TEST_F(Se3Test, AngleOfARotation) {
  for (const double angle : {0.0, 1e-10, 0.5, 3.0, kPi}) {
    EXPECT_NEAR(rotation_angle_rad(se3_exp(twist(angle, 4.0))), angle, 1e-9);
  }
  EXPECT_NEAR(rotation_angle_rad(se3_exp(twist(1.5 * kPi, 4.0))), 0.5 * kPi, 1e-12);
}

}  // namespace
}  // namespace rilo
