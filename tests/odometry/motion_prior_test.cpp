// The prior by hand: a random walk of the velocity.
#include "odometry/motion_prior.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace rilo {
namespace {

TEST(MotionPrior, CovarianceOfPoseAndVelocity) {
  MotionPriorConfig config;
  config.acceleration_m_s2 = 3.0;
  constexpr double kDt = 0.2;
  const Matrix6d V = 0.04 * Matrix6d::Identity();
  const MotionPrior prior = motion_prior({}, V, {kDt}, config);
  const Matrix12d P = prior.information.ldlt().solve(Matrix12d::Identity());
  const double q = 9.0 * 0.1;  // (m/s²)² over a tenth of a second
  EXPECT_NEAR(P(3, 3), kDt * kDt * 0.04 + kDt * kDt * kDt / 3.0 * q, 1e-9);
  EXPECT_NEAR(P(3, 9), kDt * 0.04 + kDt * kDt / 2.0 * q, 1e-9);
  EXPECT_NEAR(P(9, 9), 0.04 + kDt * q, 1e-9);
}

TEST(MotionPrior, BackwardsTheVelocityMovesThePoseTheOtherWay) {
  const Matrix6d V = 0.04 * Matrix6d::Identity();
  const Matrix12d after = motion_prior({}, V, {0.2}, {}).information;
  const Matrix12d before = motion_prior({}, V, {-0.2}, {}).information;
  Matrix12d mirrored = after;
  mirrored.topRightCorner<6, 6>() *= -1.0;
  mirrored.bottomLeftCorner<6, 6>() *= -1.0;
  EXPECT_TRUE(before.isApprox(mirrored, 1e-12));
}

TEST(MotionPrior, AnErrorOfTheTimeIsOneAlongTheMotion) {
  const Matrix6d V = 0.04 * Matrix6d::Identity();
  MotionState moving;
  moving.T_odom_lidar.linear() = so3_exp({0.0, 0.0, 0.5 * M_PI});  // looks along y
  moving.twist << 0.0, 0.0, 0.5, 10.0, 0.0, 0.0;
  const auto covariance = [&](double error_s) {
    const Matrix12d information = motion_prior(moving, V, {0.1, error_s}, {}).information;
    return Matrix12d(information.ldlt().solve(Matrix12d::Identity()));
  };
  const Matrix12d more = covariance(0.003) - covariance(0.0);
  Vector12d off = Vector12d::Zero();
  off[2] = 0.5 * 0.003;
  off[4] = 10.0 * 0.003;
  EXPECT_TRUE(more.isApprox(off * off.transpose(), 1e-6)) << more;
}

TEST(MotionPrior, SpeedGoesOnAndTurningFades) {
  MotionState last;
  last.twist << 0.0, 0.0, 1.0, 10.0, 0.0, 0.0;
  const MotionState next = expected_motion(last, 0.1);
  EXPECT_NEAR(next.twist[2], std::exp(-0.1), 1e-12);
  EXPECT_NEAR(next.twist[3], 10.0, 1e-12);
  EXPECT_NEAR(next.T_odom_lidar.translation().norm(), 1.0, 1e-3);
}

TEST(MotionPrior, SwitchedOffItSaysNothing) {
  MotionPriorConfig config;
  config.enabled = false;
  EXPECT_EQ(motion_prior({}, Matrix6d::Identity(), {0.1}, config).information, Matrix12d::Zero());
}

TEST(MotionPrior, AnUnknownVelocityIsThatOfACarOrAHand) {
  Vector6d squares;
  squares << 1.0, 1.0, 1.0, 400.0, 400.0, 400.0;  // (1 rad/s)², (20 m/s)²
  EXPECT_EQ(unknown_velocity_covariance(), Matrix6d(squares.asDiagonal()));
}

}  // namespace
}  // namespace rilo
