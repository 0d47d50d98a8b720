// Sweeps that come long after the last: where they are searched, and when they are believed.
#include <cmath>

#include <gtest/gtest.h>

#include "odometry/motion_tracker.hpp"
#include "odometry/sweep_judge.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

TEST(Reach, IsTheRandomWalkOfTheVelocity) {
  MotionPriorConfig prior;
  prior.acceleration_m_s2 = 10.0;
  prior.angular_acceleration_rad_s2 = 2.0;
  MotionTracker tracker({}, prior, {});
  tracker.begin({});
  IcpResult icp;
  icp.state.twist << 0.0, 0.0, 0.5, 10.0, 0.0, 0.0;
  icp.posterior_information.setIdentity();
  icp.posterior_information.bottomRightCorner<6, 6>() *= 1e8;  // the velocity is certain
  tracker.advance({0, 100'000'000, 100'000'000});
  tracker.accept(icp, MotionVerdict::kPossible, false);
  tracker.advance({0, 2'000'000'000, 2'000'000'000});
  const Reach reach = tracker.reach();
  EXPECT_NEAR(reach.sigma_m, std::sqrt(10.0 * 10.0 * 0.1 * 8.0 / 3.0), 1e-3);  // acceleration² · 0.1 s · t³ / 3
  EXPECT_NEAR(reach.sigma_rad, std::sqrt(2.0 * 2.0 * 0.1 * 8.0 / 3.0), 1e-3);
  EXPECT_TRUE(reach.T_odom_centre.isApprox(expected_motion({SE3::Identity(), icp.state.twist}, 2.0).T_odom_lidar));
}

TEST(Reach, EndsAtThreeStandardDeviations) {
  Reach reach;
  reach.T_odom_centre.translation().x() = 20.0;
  reach.sigma_m = 2.0;
  reach.sigma_rad = 0.1;
  const auto contains = [&](double x_m, double yaw_rad) {
    SE3 T = SE3::Identity();
    T.linear() = so3_exp({0.0, 0.0, yaw_rad});
    T.translation().x() = x_m;
    return reach.contains(T);
  };
  EXPECT_TRUE(contains(14.1, 0.29));
  EXPECT_FALSE(contains(13.9, 0.0));
  EXPECT_FALSE(contains(20.0, 0.31));
}

/// A judge to whom residuals of 2 cm and a quality of 30 are usual.
class AfterAGap : public ::testing::Test {
 protected:
  AfterAGap() {
    place_.source.points.resize(1000, Eigen::Vector3f::UnitX());
    place_.median_range_m = 10.0;
    found_.icp.termination = IcpTermination::kConverged;
    found_.icp.degeneracy.relative_eigenvalues.setConstant(1.0);
    found_.icp.residual_rms_m = 0.02;
    found_.score = 0.8;
    found_.quality = 30.0;
    judge_.begin(place_, false);
    judge_.accept(place_, found_, false);
  }

  OdometryStatus status(bool after_gap = true, bool was_lost = false) const {
    return judge_.judge(place_, found_, MotionVerdict::kPossible, {10, 0.8, 30.0, was_lost, after_gap}).status;
  }

  PreparedSweep place_;
  Registration found_;
  SweepJudge judge_{HealthConfig()};
};

TEST_F(AfterAGap, LittleMayFitButClosely) {
  found_.score = 0.15;  // the map ends where the sensor is
  found_.quality = 4.0;
  found_.icp.residual_rms_m = 0.039;
  EXPECT_EQ(status(), OdometryStatus::kOk);
  EXPECT_EQ(status(true, true), OdometryStatus::kRecovered);
  EXPECT_EQ(status(false), OdometryStatus::kLost);
  found_.score = 0.75;
  found_.quality = 12.0;
  found_.icp.residual_rms_m = 0.041;  // another aisle between racks
  EXPECT_EQ(status(), OdometryStatus::kLost);
  EXPECT_EQ(status(true, true), OdometryStatus::kLost);
  EXPECT_EQ(status(false), OdometryStatus::kOk);
}

TEST_F(AfterAGap, WithHeldMatchesHalfOfTheQualityMustBeLeft) {
  found_.icp.frozen = true;
  found_.quality = 15.1;
  EXPECT_EQ(status(), OdometryStatus::kOk);
  found_.quality = 14.9;
  EXPECT_EQ(status(), OdometryStatus::kLost);
  EXPECT_EQ(status(false), OdometryStatus::kOk);
}

// A sweep of a stretch elsewhere, on other houses: they show the way a quarter as well.
TEST_F(AfterAGap, WhatShowsADirectionMuchLessMustFitAsUsualToo) {
  found_.score = 0.35;
  found_.icp.degeneracy.relative_eigenvalues[0] = 0.26;
  EXPECT_EQ(status(true, true), OdometryStatus::kRecovered);
  found_.icp.degeneracy.relative_eigenvalues[0] = 0.24;
  EXPECT_EQ(status(true, true), OdometryStatus::kLost);
  found_.score = 0.57;
  EXPECT_EQ(status(true, true), OdometryStatus::kRecovered);
}

TEST_F(AfterAGap, WhatLeavesADirectionOpenMustFitAsUsualToo) {
  found_.icp.degeneracy.relative_eigenvalues[0] = 0.001;
  EXPECT_EQ(status(), OdometryStatus::kDegenerate);
  found_.score = 0.39;
  EXPECT_EQ(status(), OdometryStatus::kLost);
  found_.score = 0.8;
  found_.icp.residual_rms_m = 0.05;
  EXPECT_EQ(status(), OdometryStatus::kLost);
}

TEST_F(AfterAGap, ANewMapHasNoUsualResiduals) {
  judge_.begin(place_, false);
  found_.icp.residual_rms_m = 0.1;
  EXPECT_EQ(status(), OdometryStatus::kOk);
}

constexpr LossCause kSearchedInVain = LossCause::kFoundByChance;

TEST_F(AfterAGap, AMapIsGivenUpAfterThreeTries) {
  EXPECT_FALSE(judge_.give_up(true, 16.0, kSearchedInVain));
  EXPECT_FALSE(judge_.give_up(true, 17.0, kSearchedInVain));
  EXPECT_TRUE(judge_.give_up(true, 18.0, kSearchedInVain));
  judge_.accept(place_, found_, false);
  EXPECT_FALSE(judge_.give_up(true, 6.0, kSearchedInVain));
  EXPECT_FALSE(judge_.give_up(true, 7.0, kSearchedInVain));
  EXPECT_FALSE(judge_.give_up(true, 8.0, kSearchedInVain)) << "a gap of half a second";
}

TEST_F(AfterAGap, TriesBeforeTheLastAcceptedSweepAreForgotten) {
  EXPECT_FALSE(judge_.give_up(true, 1.0, kSearchedInVain));
  EXPECT_FALSE(judge_.give_up(true, 2.0, kSearchedInVain));
  judge_.accept(place_, found_, false);
  EXPECT_FALSE(judge_.give_up(true, 16.0, kSearchedInVain)) << "the first of three";
  EXPECT_FALSE(judge_.give_up(true, 17.0, kSearchedInVain));
  EXPECT_TRUE(judge_.give_up(true, 18.0, kSearchedInVain));
}

// Its sweeps would fit a map of what covers the sensor, which moves along with it.
TEST_F(AfterAGap, ACoveredSensorIsNoTry) {
  for (int covered = 0; covered < 4; ++covered) {
    EXPECT_FALSE(judge_.give_up(true, 16.0 + covered, LossCause::kCovered));
  }
  EXPECT_FALSE(judge_.give_up(true, 20.0, kSearchedInVain));
  EXPECT_FALSE(judge_.give_up(true, 21.0, kSearchedInVain));
  EXPECT_TRUE(judge_.give_up(true, 22.0, kSearchedInVain));
}

// Two seconds are missing in which a car turns into another street, 16 m on.
TEST(LongGap, ASweepIsFoundAgainAtOnce) {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.speed_mps = 14.0;
  config.start_s = 15.5;
  config.sweeps = 45;
  const DriveSimulator simulator(config);
  Odometry odometry({});
  SE3 T_odom_world = SE3::Identity();
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    if (i >= 20 && i < 40) {
      continue;
    }
    const SimulatedSweep s = simulator.sweep(i);
    const SweepResult result = odometry.register_sweep(s.sweep);
    if (i == 19) {
      T_odom_world = result.T_odom_lidar * s.T_odom_lidar_mid.inverse();
    } else if (i >= 40) {
      EXPECT_EQ(result.status, OdometryStatus::kOk) << i;
      const SE3 error = (T_odom_world * s.T_odom_lidar_mid).inverse() * result.T_odom_lidar;
      EXPECT_LT(error.translation().norm(), 0.05) << i;
    }
  }
}

}  // namespace
}  // namespace rilo
