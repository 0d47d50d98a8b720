// The covariance of a pose by hand.
#include "odometry/pose_covariance.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace rilo {
namespace {

IcpResult with_information(double sweep, double prior) {
  IcpResult icp;
  icp.sweep_information = sweep * Matrix12d::Identity();
  icp.posterior_information = icp.sweep_information + prior * Matrix12d::Identity();
  return icp;
}

TEST(PoseCovarianceByHand, TheSweepCountsThirtyTimesExceptWhereADirectionIsHidden) {
  const IcpResult icp = with_information(100.0, 50.0);
  PoseCovariance covariance;
  EXPECT_NEAR(covariance.of(icp, false, Vector6d::Zero(), 0.0, Vector6d::Zero())(3, 3), 1.0 / 3050.0, 1e-8);
  EXPECT_NEAR(covariance.of(icp, true, Vector6d::Zero(), 0.0, Vector6d::Zero())(3, 3), 1.0 / 150.0, 1e-6);
}

// 3 m/s in a sweep of 0.1 s.
const Vector6d kAcceleration = 30.0 * Vector6d::Unit(3);

TEST(PoseCovarianceByHand, AChangeOfVelocityDuringTheSweepCounts) {
  const IcpResult icp = with_information(1e12, 0.0);
  PoseCovariance covariance;
  // A fifth of (3 m/s)² is learnt at once; 0.1 s / 24 of that velocity is the mean lag.
  const double expected = 0.2 * 9.0 * 0.01 / (24.0 * 24.0);
  EXPECT_NEAR(covariance.of(icp, false, kAcceleration, 0.1, Vector6d::Zero())(3, 3), expected, 1e-9);
}

TEST(PoseCovarianceByHand, OfAChangeThatPointsAreCompensatedForHalfItsOwnChangeCounts) {
  IcpResult icp = with_information(1e12, 0.0);
  icp.state.earlier.lag_s = 0.1;
  PoseCovariance covariance;
  const double expected = 0.2 * 1.5 * 1.5 * 0.01 / (24.0 * 24.0);
  EXPECT_NEAR(covariance.of(icp, false, kAcceleration, 0.1, Vector6d::Zero())(3, 3), expected, 1e-9);
  // As much again: a steady acceleration, and what was learnt fades.
  EXPECT_NEAR(covariance.of(icp, false, kAcceleration, 0.1, Vector6d::Zero())(3, 3), 0.8 * expected, 1e-9);
}

// With the prior off, nothing may be known of a direction.
TEST(PoseCovarianceByHand, OfADirectionThatIsNotSeenAGuessIsKnown) {
  IcpResult icp;
  icp.sweep_information = Matrix12d::Zero();
  icp.sweep_information.diagonal() << 1e6, 1e6, 1e6, 0.0, 1e6, 1e6, 0, 0, 0, 0, 0, 0;
  icp.posterior_information = icp.sweep_information;
  const Matrix6d C = PoseCovariance().of(icp, true, Vector6d::Zero(), 0.1, Vector6d::Zero());
  EXPECT_GT(C(3, 3), 1.0);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6d>(C).eigenvalues()[0], 0.0);
}

TEST(PoseCovarianceByHand, WhatARegistrationCutShortHadLeftToMoveCounts) {
  IcpResult icp = with_information(1e12, 0.0);
  icp.last_update[3] = 0.2;  // along x of the odometry frame, which is -y of the sensor
  icp.state.T_odom_lidar.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, 1.57079632679489662));
  EXPECT_NEAR(PoseCovariance().of(icp, false, Vector6d::Zero(), 0.0, Vector6d::Zero())(4, 4), 0.0, 1e-9);
  icp.termination = IcpTermination::kTimeLimit;
  EXPECT_NEAR(PoseCovariance().of(icp, false, Vector6d::Zero(), 0.0, Vector6d::Zero())(4, 4), 0.04, 1e-9);
}

TEST(PoseCovarianceByHand, IsInTheSensorsOwnAxes) {
  IcpResult icp;
  icp.posterior_information = Matrix12d::Identity();
  icp.posterior_information(3, 3) = 100.0;  // x of the odometry frame is known well
  icp.state.T_odom_lidar.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, 1.57079632679489662));
  const Matrix6d C = PoseCovariance().of(icp, true, Vector6d::Zero(), 0.0, Vector6d::Zero());
  EXPECT_NEAR(C(3, 3), 1.0, 3e-3);
  EXPECT_NEAR(C(4, 4), 0.01, 1e-6);
}

TEST(PoseCovarianceByHand, OfWhatAHandShakesFourTenthsCountOnAverage) {
  const IcpResult icp = with_information(1e12, 0.0);
  const Vector6d shaken = 1e-4 * Vector6d::Unit(4);
  PoseCovariance covariance;
  EXPECT_NEAR(covariance.of(icp, false, Vector6d::Zero(), 0.0, shaken)(4, 4), 0.4 * 0.2 * 1e-4, 1e-12);
  EXPECT_NEAR(covariance.of(icp, false, Vector6d::Zero(), 0.0, shaken)(4, 4), 0.4 * 0.36 * 1e-4, 1e-12);
  EXPECT_NEAR(covariance.of(icp, false, Vector6d::Zero(), 0.0, Vector6d::Zero())(4, 4), 0.4 * 0.288 * 1e-4, 1e-12);
  covariance.reset();
  EXPECT_NEAR(covariance.of(icp, false, Vector6d::Zero(), 0.0, Vector6d::Zero())(4, 4), 0.0, 1e-12);
}

}  // namespace
}  // namespace rilo
