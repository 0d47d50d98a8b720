#include "simulation/drive_path.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "simulation/terrain.hpp"
#include "simulation/vehicle.hpp"

namespace rilo {
namespace {

constexpr double kSpeed = 10.5;

const DrivePath& path() {
  static const DrivePath kPath(kSpeed, 80);
  return kPath;
}

const simulation::Terrain& terrain() {
  static const simulation::Terrain kTerrain(3);
  return kTerrain;
}

SE3 pose(double t) { return simulation::sensor_pose(path(), terrain(), 1.73, t); }

// Largest change of the second derivative within `step`: of a C2 curve it shrinks with the step, of others it does not.
double largest_jump(const std::function<Eigen::Vector3d(double)>& f, double step) {
  const auto second = [&](double t) -> Eigen::Vector3d {
    constexpr double kH = 2e-4;
    return (f(t + kH) - 2 * f(t) + f(t - kH)) / (kH * kH);
  };
  double largest = 0;
  for (double t = 0.5; t < 40; t += 0.0371) largest = std::max(largest, (second(t + step) - second(t)).norm());
  return largest;
}

TEST(DrivePath, DerivativesAreThoseOfTheDistance) {
  constexpr double kH = 1e-4;
  for (double t = 0; t < 70; t += 0.173) {
    const double before = path().distance_m(t - kH);
    const double after = path().distance_m(t + kH);
    EXPECT_NEAR(path().speed_mps(t), (after - before) / (2 * kH), 1e-5);
    EXPECT_NEAR(path().acceleration_mps2(t), (path().speed_mps(t + kH) - path().speed_mps(t - kH)) / (2 * kH), 1e-4);
  }
}

TEST(DrivePath, PositionsAreC2InTime) {
  const auto position = [](double t) -> Eigen::Vector3d { return pose(t).translation(); };
  const double jump = largest_jump(position, 0.01);
  EXPECT_LT(jump, 0.25);  // m/s²
  EXPECT_LT(largest_jump(position, 0.002), 0.25 * jump);
}

TEST(DrivePath, AttitudesAreC2InTime) {
  const auto attitude = [](double t) -> Eigen::Vector3d { return pose(t).linear().col(0) + pose(t).linear().col(2); };
  const double jump = largest_jump(attitude, 0.01);
  EXPECT_LT(jump, 0.25);  // rad/s²
  EXPECT_LT(largest_jump(attitude, 0.002), 0.25 * jump);
}

TEST(DrivePath, KeepsToSpeedAndAcceleration) {
  double fastest = 0;
  double slowest_lateral = 0;
  for (double t = 0; t < 80; t += 0.02) {
    const double v = path().speed_mps(t);
    EXPECT_GE(v, -1e-9) << t;
    EXPECT_LE(v, kSpeed + 1e-9) << t;
    EXPECT_LE(std::abs(path().acceleration_mps2(t)), 2.3) << t;
    fastest = std::max(fastest, v);
    slowest_lateral = std::max(slowest_lateral, v * v * std::abs(path().curvature_per_m(path().distance_m(t))));
  }
  EXPECT_GT(fastest, 7);
  EXPECT_GT(slowest_lateral, 1.5);  // bends are felt,
  EXPECT_LT(slowest_lateral, 3.5);  // yet nobody skids
}

TEST(DrivePath, StandsAtTheStartAndOnceMoreInALap) {
  int stops = 0;
  bool standing = true;
  for (double t = 0.05; t < path().lap_s() - 5; t += 0.05) {
    const bool stands = path().speed_mps(t) < 1e-9;
    stops += stands && !standing ? 1 : 0;
    standing = stands;
  }
  EXPECT_EQ(path().speed_mps(0), 0);
  EXPECT_EQ(path().distance_m(0), 0);
  EXPECT_EQ(stops, 1);
}

TEST(DrivePath, ClosesItsLoop) {
  EXPECT_NEAR(path().distance_m(path().lap_s()), path().lap_m(), 1e-9);
  EXPECT_TRUE(path().position(path().lap_m()).isApprox(path().position(0), 1e-12));
  EXPECT_TRUE(pose(path().lap_s()).isApprox(pose(0), 1e-9));
  EXPECT_TRUE(path().position(-7).isApprox(path().position(path().lap_m() - 7), 1e-9));
  // Overlap: the second lap follows the first, driven as then.
  EXPECT_TRUE(pose(path().lap_s() + 6.5).matrix().isApprox(pose(6.5).matrix(), 2e-2));
}

TEST(DrivePath, TurnsBothWays) {
  double most = 0;
  double least = 0;
  double turned = 0;
  constexpr double kStep = 0.1;
  for (double s = 0; s < path().lap_m(); s += kStep) {
    const double curvature = path().curvature_per_m(s);
    most = std::max(most, curvature);
    least = std::min(least, curvature);
    turned += curvature * (path().position(s + kStep) - path().position(s)).norm();
  }
  EXPECT_GT(most, 0.07);
  EXPECT_LT(least, -0.07);
  EXPECT_NEAR(turned, 2 * M_PI, 0.05);  // once round, counter-clockwise
}

TEST(DrivePath, StaysStillBeyondItsEnd) {
  const DrivePath brief(5, 10);
  EXPECT_EQ(brief.speed_mps(1e4), 0);
  EXPECT_EQ(brief.distance_m(1e4), brief.distance_m(2e4));
  EXPECT_LT(brief.distance_m(-1e4), 0);
}

TEST(SensorPose, LeansOutOfBendsAndDivesWhenBraking) {
  double roll_left_turn = 0;
  double dive = 0;
  for (double t = 0; t < 50; t += 0.05) {
    const double s = path().distance_m(t);
    const Eigen::Vector2d p = path().position(s);
    const Eigen::Vector2d d = path().direction(s);
    const Eigen::Vector2d left(-d.y(), d.x());
    const SE3 T = pose(t);
    const double ground_left = (terrain().height(p + 0.78 * left) - terrain().height(p - 0.78 * left)) / 1.56;
    const double ground_ahead = (terrain().height(p + 1.35 * d) - terrain().height(p - 1.35 * d)) / 2.7;
    if (path().curvature_per_m(s) > 0.05) roll_left_turn = std::max(roll_left_turn, T.linear()(2, 1) - ground_left);
    if (path().acceleration_mps2(t) < -1.5) dive = std::min(dive, T.linear()(2, 0) - ground_ahead);
  }
  EXPECT_GT(roll_left_turn, 0.008);  // the left side rises in a left turn
  EXPECT_LT(dive, -0.008);
}

}  // namespace
}  // namespace rilo
