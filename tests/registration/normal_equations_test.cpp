// Sums of residuals: one by one, in blocks, and along several directions at once.
#include "registration/normal_equations.hpp"

#include <gtest/gtest.h>

#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

using test::twist;

// Two residuals of one point along two directions, one by one and together.
TEST(NormalEquationsSum, DirectionsOfOnePointTogether) {
  const Eigen::Vector3d q(3.0, -2.0, 0.7);
  const Eigen::Vector3d d1 = Eigen::Vector3d(0.2, 0.9, -0.3).normalized();
  const Eigen::Vector3d d2 = d1.cross(Eigen::Vector3d(1.0, 0.5, 0.1)).normalized();
  const double w1 = 0.8;
  const double w2 = 0.3;
  const double e1 = 0.02;
  const double e2 = -0.05;
  const double offset_s = -0.03;
  NormalEquations singly;
  Vector6d J1;
  Vector6d J2;
  J1 << q.cross(d1), d1;
  J2 << q.cross(d2), d2;
  ResidualBlock one_by_one(singly);
  one_by_one.add(J1, e1, w1, offset_s);
  one_by_one.add(J2, e2, w2, offset_s);
  one_by_one.flush();
  NormalEquations together;
  ResidualBlock at_once(together);
  at_once.add(q, w1 * d1 * d1.transpose() + w2 * d2 * d2.transpose(), w1 * e1 * d1 + w2 * e2 * d2, w1 + w2,
              w1 * e1 * e1 + w2 * e2 * e2, 2, offset_s);
  at_once.flush();
  EXPECT_TRUE(together.hessian().isApprox(singly.hessian(), 1e-12));
  EXPECT_TRUE(together.gradient().isApprox(singly.gradient(), 1e-12));
  EXPECT_DOUBLE_EQ(together.weight, singly.weight);
  EXPECT_DOUBLE_EQ(together.squared_error, singly.squared_error);
  EXPECT_EQ(together.count, singly.count);
}

TEST(NormalEquationsSum, BlocksOfAnyLengthAddUpAsOneByOne) {
  NormalEquations singly;
  NormalEquations together;
  ResidualBlock block(together);
  for (int i = 0; i < 100; ++i) {
    const Vector6d J = twist(1, 0.1 * i, 3, -4, 5, 0.2 * i);
    const double s = 0.001 * (i - 50);
    ResidualBlock one(singly);
    one.add(J, 0.01 * i, 0.5, s);
    one.flush();
    block.add(J, 0.01 * i, 0.5, s);
  }
  block.flush();
  EXPECT_EQ(together.hessian(), singly.hessian());
  EXPECT_EQ(together.gradient(), singly.gradient());
  EXPECT_EQ(together.count, 100U);
}

TEST(NormalEquationsSum, AddsBlockByBlock) {
  const Vector6d J = twist(1, 2, 3, 4, 5, 6);
  NormalEquations a;
  ResidualBlock block(a);
  block.add(J, 0.5, 2.0, 0.1);
  block.flush();
  NormalEquations b;
  b.add(J, -1.0, 1.0);
  a += b;
  EXPECT_EQ(a.count, 2U);
  EXPECT_DOUBLE_EQ(a.weight, 3.0);
  EXPECT_DOUBLE_EQ(a.squared_error, 2.0 * 0.25 + 1.0);
  EXPECT_TRUE(a.pose_hessian().isApprox(3.0 * J * J.transpose()));
  EXPECT_TRUE((a.hessian().topRightCorner<6, 6>().isApprox(0.2 * J * J.transpose())));
  EXPECT_TRUE((a.hessian().bottomLeftCorner<6, 6>().isApprox(0.2 * J * J.transpose())));
  EXPECT_TRUE((a.hessian().bottomRightCorner<6, 6>().isApprox(0.02 * J * J.transpose())));
  EXPECT_LT((a.gradient().head<6>() - (1.0 - 1.0) * J).norm(), 1e-15);
  EXPECT_TRUE(a.gradient().tail<6>().isApprox(0.1 * J));
}

}  // namespace
}  // namespace rilo
