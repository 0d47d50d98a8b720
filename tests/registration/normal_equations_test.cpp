// Sums of residuals: one by one and in blocks.
#include "registration/normal_equations.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

/// J = [(q × d)ᵀ dᵀ].
Vector6d jacobian(const Eigen::Vector3f& q, const Eigen::Vector3f& d) {
  Vector6d J;
  J << q.cross(d).cast<double>(), d.cast<double>();
  return J;
}

TEST(NormalEquationsSum, BlocksOfAnyLengthAddUpAsOneByOne) {
  NormalEquations singly;
  NormalEquations together;
  ResidualBlock block(together);
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(i);
    const Eigen::Vector3f q(40.0F - x, 0.3F * x, -1.7F);
    const Eigen::Vector3f d = Eigen::Vector3f(0.01F * x, 1.0F, -0.02F * x).normalized();
    const double e = 0.01 * (i % 7 - 3);
    singly.add(jacobian(q, d), e, 0.5);
    block.add(q, d, e, 0.5, 0.001 * (i - 50));
  }
  block.flush();
  EXPECT_TRUE(together.pose_hessian().isApprox(singly.pose_hessian(), 1e-6));
  EXPECT_TRUE(together.gradient().head<6>().isApprox(singly.gradient().head<6>(), 1e-5));
  EXPECT_DOUBLE_EQ(together.weight, singly.weight);
  EXPECT_NEAR(together.squared_error, singly.squared_error, 1e-12);
  EXPECT_EQ(together.count, 100U);
}

TEST(NormalEquationsSum, AddsBlockByBlock) {
  const Eigen::Vector3f q(1, 2, 3);
  const Eigen::Vector3f d(4, 5, 6);
  const Vector6d J = jacobian(q, d);
  NormalEquations a;
  ResidualBlock block(a);
  block.add(q, d, 0.5, 2.0, 0.125);
  block.flush();
  NormalEquations b;
  b.add(J, -1.0, 1.0);
  a += b;
  EXPECT_EQ(a.count, 2U);
  EXPECT_DOUBLE_EQ(a.weight, 3.0);
  EXPECT_DOUBLE_EQ(a.squared_error, 2.0 * 0.25 + 1.0);
  EXPECT_TRUE(a.pose_hessian().isApprox(3.0 * J * J.transpose()));
  EXPECT_TRUE((a.hessian().topRightCorner<6, 6>().isApprox(0.25 * J * J.transpose())));
  EXPECT_TRUE((a.hessian().bottomLeftCorner<6, 6>().isApprox(0.25 * J * J.transpose())));
  EXPECT_TRUE((a.hessian().bottomRightCorner<6, 6>().isApprox(0.03125 * J * J.transpose())));
  EXPECT_LT((a.gradient().head<6>() - (1.0 - 1.0) * J).norm(), 1e-15);
  EXPECT_TRUE(a.gradient().tail<6>().isApprox(0.125 * J));
}

TEST(NormalEquationsSum, WithoutVelocityItsPartStaysZero) {
  NormalEquations sums;
  ResidualBlock block(sums, false);
  block.add({1, 2, 3}, {0, 0, 1}, 0.5, 2.0, 0.0);
  block.flush();
  EXPECT_TRUE((sums.hessian().rightCols<6>().isZero()));
  EXPECT_TRUE(sums.gradient().tail<6>().isZero());
  EXPECT_FALSE(sums.pose_hessian().isZero());
}

}  // namespace
}  // namespace rilo
