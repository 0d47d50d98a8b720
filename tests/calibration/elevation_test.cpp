// The sensor's elevation error: Jacobians, the map that follows it, and the calibration on simulated drives.
#include "cloud/elevation.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "calibration/sensor_calibration.hpp"
#include "map/local_map.hpp"
#include "registration/registration_scenes.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::kDegree;
using test::scene_map_config;

TEST(Elevation, ATurnKeepsRangeAndAzimuthAndAddsTheAngle) {
  const ElevationRotation turn(0.01);
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(10, 0, 0), Eigen::Vector3f(-3, 4, -2), Eigen::Vector3f(1, -7, 5)}) {
    const Eigen::Vector3f q = turn(p);
    EXPECT_NEAR(q.norm(), p.norm(), 1e-5F);
    EXPECT_NEAR(std::atan2(q.y(), q.x()), std::atan2(p.y(), p.x()), 1e-6F);
    EXPECT_NEAR(std::asin(q.z() / q.norm()) - std::asin(p.z() / p.norm()), 0.01F, 1e-6F);
  }
  EXPECT_TRUE(turn({0, 0, 5}).allFinite());
  EXPECT_TRUE(elevation_jacobian({0, 0, 5}).isZero());
}

TEST(Elevation, TheLeverIsTheDerivativeOfTheTurn) {
  constexpr double kStep = 1e-3;
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(10, 0, 0), Eigen::Vector3f(-3, 4, -2), Eigen::Vector3f(1, -7, 5)}) {
    const Eigen::Vector3f numeric =
        (ElevationRotation(kStep)(p) - ElevationRotation(-kStep)(p)) / static_cast<float>(2 * kStep);
    EXPECT_LT((numeric - elevation_jacobian(p)).norm(), 2e-3F);
  }
}

TEST(Elevation, TheMapMovesAsIfItHadBeenMadeOfTurnedPoints) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> uniform(-0.1F, 0.1F);
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> turned;
  const double angle = 0.002;
  const ElevationRotation turn(angle);
  for (int i = 0; i < 15; ++i) {
    points.emplace_back(10.1F + uniform(rng), 2.1F + uniform(rng), -1.9F);
    turned.push_back(turn(points.back()));
  }
  SE3 T = SE3::Identity();
  T.translation() << 3, -1, 0.5;
  LocalMap map(scene_map_config());
  map.insert(points, T);
  map.shift_elevation(angle, {});
  LocalMap expected(scene_map_config());
  expected.insert(turned, T);
  MapPlane plane;
  MapPlane expected_plane;
  const Eigen::Vector3d centre = T * Eigen::Vector3d(10.1, 2.1, -1.9);
  ASSERT_TRUE(map.find(centre, plane));
  ASSERT_TRUE(expected.find(centre, expected_plane));
  EXPECT_LT((plane.point - expected_plane.point).norm(), 1e-4);
  EXPECT_LT(plane.normal.cross(expected_plane.normal).norm(), 1e-5);
  EXPECT_GT(std::abs(plane.point.z() - centre.z()), 0.015);  // it did move
  // Seen from a sensor that moves along, nothing does.
  LocalMap along(scene_map_config());
  along.insert(points, T, {});
  Eigen::Vector3d elevation_jacobian = Eigen::Vector3d::Zero();
  along.visit(
      0, 1, [&](std::size_t) -> const Eigen::Vector3d& { return centre; },
      [&](std::size_t, const Eigen::Vector3d&, const PlaneSpot& spot) {
        elevation_jacobian = spot.grid->elevation_jacobian_at(spot, centre, {});
      });
  const PoseDerivative pose_derivative{centre, Eigen::Vector3d::Zero(), elevation_jacobian};
  along.shift_elevation(angle, pose_derivative);
  ASSERT_TRUE(along.find(centre, plane));
  EXPECT_LT((plane.point - centre).norm(), 0.1);
  EXPECT_NEAR(plane.point.z(), centre.z(), 1e-4);
}

/// A room as a sensor sees it whose elevation angles are 0.3° too small.
std::vector<Eigen::Vector3f> room_seen_low(const SceneSampling& sampling) {
  std::vector<Eigen::Vector3f> points = make_box_room({9.3, 7.1, 3.3}, sampling);
  for (Eigen::Vector3f& p : points) {
    p = ElevationRotation(-0.3 * kDegree)(p);
  }
  return points;
}

TEST(Elevation, TheMapMovesOnceAndNotBeforeItIsTold) {
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  LocalMap map(scene_map_config());
  map.set_scene_range(6.0);
  map.insert(room_seen_low(sampling), SE3::Identity());
  IcpResult icp;
  icp.state.T_odom_lidar.translation() << 2.5, 1.5, 0.3;
  icp.posterior_information = 1e9 * Matrix12d::Identity();
  icp.unit_information = 25.0;  // as with the usual noise and share
  sampling.spacing_m = 0.11;
  sampling.T_world_sensor = icp.state.T_odom_lidar;
  PreparedSweep sweep;
  sweep.source.points = room_seen_low(sampling);
  SensorCalibration calibration({}, BeamCalibrationConfig{false});
  for (int i = 0; i < 30 && calibration.elevation().applied_rad() == 0.0; ++i) {
    calibration.learn(sweep, icp, 0.3, {}, true, map);
  }
  ASSERT_GT(calibration.elevation().applied_rad(), 0.0);
  const std::vector<Eigen::Vector3f> before = map.points();
  calibration.move(map);
  const std::vector<Eigen::Vector3f> after = map.points();
  EXPECT_NE(before, after);
  calibration.move(map);
  EXPECT_EQ(map.points(), after);
}

TEST(Elevation, OfAYoungMapThePoseStillFollowsTheAngle) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  IcpResult icp;
  icp.state.T_odom_lidar = se3_exp(test::twist(0.0, 0.002, 0.01, 0.6, 0.2, 0.01));
  icp.posterior_information = 1e8 * Matrix12d::Identity();
  icp.unit_information = 25.0;
  PreparedSweep sweep;
  sweep.source.points = test::seen_from(icp.state.T_odom_lidar, test::rimless_room(0.23, 0.37, 1.3));
  SensorCalibration calibration({}, BeamCalibrationConfig{false});
  PoseDerivative before;
  for (int i = 0; i < 2; ++i) {  // each from the one before
    calibration.learn(sweep, icp, 0.3, {}, false, map);
    before = elevation_information(sweep.source, map, icp, 0.3, {}, before, 4).pose;
    EXPECT_GT(before.translation.norm(), 0.0);
    EXPECT_EQ(calibration.pose_by_elevation().translation, before.translation);
    EXPECT_EQ(calibration.pose_by_elevation().rotation, before.rotation);
  }
  EXPECT_EQ(calibration.elevation().estimate().rad, 0.0) << "nothing is learnt from it";
}

SweepResult last_of(double bias_deg, const OdometryConfig& config, double* error_deg = nullptr) {
  DriveConfig drive;
  drive.elevation_bias_deg = bias_deg;
  drive.start_s = 6.0;
  drive.sweeps = 60;
  drive.sensor = SensorKind::kVlp16;
  const DriveSimulator simulator(drive);
  Odometry odometry(config);
  SweepResult result;
  SimulatedSweep sweep;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    sweep = simulator.sweep(i);
    result = odometry.register_sweep(sweep.sweep);
  }
  if (error_deg != nullptr) {
    *error_deg = rotation_angle_rad(sweep.T_odom_lidar_mid.inverse() * result.T_odom_lidar) / kDegree;
  }
  return result;
}

TEST(Elevation, AnErrorIsFoundAndCorrected) {
  double with_deg = 0;
  double without_deg = 0;
  const SweepStats stats = last_of(0.4, {}, &with_deg).stats;
  EXPECT_NEAR(stats.elevation_offset_rad / kDegree, 0.4, 0.1);
  EXPECT_NEAR(stats.elevation_applied_rad, stats.elevation_offset_rad, 0.03 * kDegree);
  OdometryConfig off;
  off.elevation.enabled = false;
  EXPECT_EQ(last_of(0.4, off, &without_deg).stats.elevation_applied_rad, 0.0);
  EXPECT_LT(with_deg, without_deg);
}

TEST(Elevation, ASensorWithoutErrorIsLeftAlone) {
  const SweepStats stats = last_of(0.0, {}).stats;
  EXPECT_EQ(stats.elevation_applied_rad, 0.0);
  EXPECT_LT(std::abs(stats.elevation_offset_rad), 3.0 * stats.elevation_offset_sigma_rad);
}

}  // namespace
}  // namespace rilo
