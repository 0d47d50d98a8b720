// What one sweep says about the elevation offset, when pose and velocity are free as well.
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "calibration/elevation_offset.hpp"
#include "calibration/sensor_calibration.hpp"
#include "cloud/elevation.hpp"
#include "map/local_map.hpp"
#include "registration/registration_scenes.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::scene_map_config;

constexpr double kUnitWeights = 1e3;  // a threshold (m) so wide that all residuals weigh the same

/// The sums of a registration when the elevation angles of sweep and map grow by `angle_rad`.
NormalEquations sums_at(double angle_rad, const TimedCloud& source, LocalMap map, const MotionState& state,
                        const PoseDerivative& pose_derivative, const AdaptiveIcpConfig& config) {
  TimedCloud turned = source;
  for (Eigen::Vector3f& p : turned.points) {
    p = ElevationRotation(angle_rad)(p);
  }
  map.shift_elevation(angle_rad, pose_derivative);
  return linearise(turned, map, state, kUnitWeights, config);
}

TEST(ElevationInformation, TheGradientAgreesWithDifferences) {
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  LocalMap map(scene_map_config());
  map.set_scene_range(6.0);
  map.insert(make_box_room({9.3, 7.1, 3.3}, sampling), SE3::Identity());
  Vector6d moved;
  moved << 0.0, 0.002, 0.01, 0.6, 0.2, 0.01;
  IcpResult icp;
  icp.state.T_odom_lidar = se3_exp(moved);
  icp.posterior_information = 1e9 * Matrix12d::Identity();
  icp.unit_information = 1.0;
  sampling.spacing_m = 0.11;
  sampling.T_world_sensor = icp.state.T_odom_lidar;
  const TimedCloud source{make_box_room({9.3, 7.1, 3.3}, sampling), {}};
  icp.state.T_odom_lidar.translation().z() += 0.01;  // residuals that are not noise alone
  AdaptiveIcpConfig config;
  config.gate = 0.001;
  const PoseDerivative pose_derivative{Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0.01, -0.02, 0.03),
                                       Eigen::Vector3d(0, 0, 0.4)};
  const ElevationInformation sweep = elevation_information(source, map, icp, kUnitWeights, config, pose_derivative, 1);
  constexpr double kStep = 2e-4;
  const auto cost_at = [&](double angle_rad) {
    return 0.5 * sums_at(angle_rad, source, map, icp.state, pose_derivative, config).squared_error;
  };
  const double numeric = (cost_at(kStep) - cost_at(-kStep)) / (2 * kStep);
  EXPECT_GT(std::abs(numeric), 1.0);
  EXPECT_NEAR(-sweep.gradient, numeric, 0.05 * std::abs(numeric));  // points change voxels
}

TEST(ElevationInformation, NothingSeenNothingSaid) {
  const ElevationInformation none = elevation_information({}, LocalMap({}), {}, 0.3, {}, {}, 1);
  EXPECT_EQ(none.information, 0.0);
  ElevationOffsetEstimator estimator({});
  for (int i = 0; i < 50; ++i) {
    estimator.add(none);
  }
  EXPECT_EQ(estimator.estimate().rad, 0.0);
  EXPECT_TRUE(std::isinf(estimator.estimate().sigma_rad));
  EXPECT_EQ(estimator.advance(), 0.0);
}

/// A sweep in a room; pose and velocity take up most of what an error of the angles does.
class ElevationAndPose : public testing::Test {
 protected:
  static constexpr double kStep = 5e-4;                   // rad
  static constexpr std::size_t kLower = kBands / 2 - 25;  // bands up to -10°

  ElevationAndPose() {
    config.gate = 0.001;
    icp.state.T_odom_lidar = se3_exp(test::twist(0.0, 0.002, 0.01, 0.6, 0.2, 0.01));
    source.points = test::seen_from(icp.state.T_odom_lidar, test::rimless_room(0.23, 0.37, 1.3));
    for (const Eigen::Vector3f& p : source.points) {
      source.offsets_s.push_back(static_cast<float>(0.05 / test::kPi) * std::atan2(p.y(), p.x()));
    }
    icp.posterior_information = linearise(source, map, icp.state, kUnitWeights, config).hessian();
    icp.posterior_information.diagonal().array() += 1.0;
    icp.unit_information = 1.0;
    less = sums_at(-kStep, source, map, icp.state, {}, config);
    usual = sums_at(0.0, source, map, icp.state, {}, config);
    more = sums_at(kStep, source, map, icp.state, {}, config);
    mixed = (more.gradient() - less.gradient()) / (2.0 * kStep);
    follows = -icp.posterior_information.ldlt().solve(mixed);
  }

  ElevationInformation information(const TimedCloud& of, const IcpResult& registered) const {
    return elevation_information(of, map, registered, kUnitWeights, config, {}, 1);
  }

  /// The gain of the lower beams alone.
  static double of_lower(const ElevationInformation& sweep) {
    return std::accumulate(sweep.by_band.begin(), sweep.by_band.begin() + kLower, 0.0);
  }

  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  AdaptiveIcpConfig config;
  IcpResult icp;
  TimedCloud source;
  NormalEquations less;
  NormalEquations usual;
  NormalEquations more;
  Vector12d mixed;    // derivative of the gradient with respect to the angle
  Vector12d follows;  // that of pose and velocity
};

// What pose and velocity can explain says nothing of the angle, and moves with it.
TEST_F(ElevationAndPose, PoseAndVelocityAreEliminated) {
  const ElevationInformation sweep = information(source, icp);
  const double square = 0.5 * (more.squared_error + less.squared_error - 2.0 * usual.squared_error) / (kStep * kStep);
  const double expected = square + mixed.dot(follows);
  EXPECT_LT(expected, 0.5 * square) << "the pose explains most of it";
  EXPECT_NEAR(sweep.information, expected, 0.1 * expected);
  EXPECT_LT((sweep.pose.rotation - follows.head<3>()).norm(), 0.1 * follows.head<3>().norm());
  EXPECT_LT((sweep.pose.translation - follows.segment<3>(3)).norm(), 0.1 * follows.segment<3>(3).norm());
}

// What an error of the lower beams alone does to the gradient, after the pose has followed.
TEST_F(ElevationAndPose, ThePoseFollowsAnErrorOfSomeBeamsToo) {
  TimedCloud lower = source;
  for (Eigen::Vector3f& p : lower.points) {
    if (std::atan2(p.z(), std::hypot(p.x(), p.y())) < -10.0 * test::kDegree) {
      p = ElevationRotation(-kStep)(p);
    }
  }
  const ElevationInformation sweep = information(source, icp);
  const double gains = (information(lower, icp).gradient - sweep.gradient) / kStep;
  const Vector12d pulls =
      (linearise(lower, map, icp.state, kUnitWeights, config).gradient() - usual.gradient()) / kStep;
  EXPECT_GT(std::abs(follows.dot(pulls)), 0.5 * std::abs(gains)) << "the pose takes up most of it";
  EXPECT_NEAR(of_lower(sweep), gains - follows.dot(pulls), 0.1 * std::abs(gains));
  IcpResult held = icp;
  held.posterior_information = 1e12 * Matrix12d::Identity();
  EXPECT_NEAR(of_lower(information(source, held)), gains, 0.02 * std::abs(gains));
}

// A second pass over the sweeps: its poses have not yet moved with the angle.
TEST_F(ElevationAndPose, ANewPassBeginsWithoutTheMotionOfTheLastPose) {
  SensorCalibration calibration({}, {});
  PreparedSweep prepared;
  prepared.source = source;
  calibration.learn(prepared, icp, kUnitWeights, config, false, map);
  EXPECT_GT(calibration.pose_by_elevation().rotation.norm(), 0.01);
  calibration.start_over();
  EXPECT_TRUE(calibration.pose_by_elevation().rotation.isZero());
  EXPECT_TRUE(calibration.pose_by_elevation().translation.isZero());
}

// Of every fourth point: each stands for four, as in the information of the registration.
TEST_F(ElevationAndPose, ASampleOfThePointsSaysAsMuchAsAllOfThem) {
  const ElevationInformation all = information(source, icp);
  const ElevationInformation sample = elevation_information(source, map, icp, kUnitWeights, config, {}, 4);
  EXPECT_NEAR(sample.information, all.information, 0.15 * all.information);
  EXPECT_NEAR(sample.jacobian_m, all.jacobian_m, 0.1 * all.jacobian_m);
  EXPECT_LT((sample.pose.rotation - all.pose.rotation).norm(), 0.1 * all.pose.rotation.norm());
}

// A registration that trusts its residuals less, since bushes scatter more than planes: all counts less, and the pose
// explains no more than before.
TEST_F(ElevationAndPose, ResidualsThatAreTrustedLessCountLess) {
  const ElevationInformation sweep = information(source, icp);
  icp.unit_information *= 0.4;
  icp.posterior_information *= 0.4;
  const ElevationInformation vague = information(source, icp);
  EXPECT_NEAR(vague.information, 0.4 * sweep.information, 1e-6 * sweep.information);
  EXPECT_NEAR(vague.gradient, 0.4 * sweep.gradient, 1e-6 * std::abs(sweep.gradient));
  EXPECT_NEAR(vague.by_band[kLower - 1], 0.4 * sweep.by_band[kLower - 1], 1e-6 * sweep.information);
  EXPECT_NEAR(vague.jacobian_m, sweep.jacobian_m, 1e-6 * sweep.jacobian_m);
  EXPECT_LT((vague.pose.rotation - sweep.pose.rotation).norm(), 1e-6 * sweep.pose.rotation.norm());
}

}  // namespace
}  // namespace rilo
