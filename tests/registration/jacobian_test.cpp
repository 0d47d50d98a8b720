// Every Jacobian of the registrations against numeric differentiation, point by point.
#include <cmath>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/coarse_registration.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

using test::twist;

constexpr double kStep = 1e-6;
constexpr double kSigmaM = 0.2;

SE3 in_sweep(const TimedCloud& cloud, std::size_t i, const MotionState& state) {
  if (!cloud.timed()) {
    return SE3::Identity();
  }
  const auto s = static_cast<double>(cloud.offsets_s[i]);
  const BodyMotion motion = state.motion();
  return se3_exp(s * motion.twist + 0.5 * s * s * motion.acceleration);
}

/// Point-to-plane residual of a point with the plane held, evaluated in double precision without tables.
double residual(const TimedCloud& cloud, std::size_t i, const MapPlane& plane, const MotionState& state) {
  const Eigen::Vector3d world = state.T_odom_lidar * (in_sweep(cloud, i, state) * cloud.points[i].cast<double>());
  return plane.normal.dot(world - plane.point);
}

struct Sums {
  Matrix12d H = Matrix12d::Zero();
  Vector12d b = Vector12d::Zero();
  std::size_t count = 0;
};

/// Hessian and gradient of half the weighted squares from numeric Jacobians; planes and weights frozen at `state`.
Sums numeric_sums(const TimedCloud& cloud, const LocalMap& map, const MotionState& state, double gate_m,
                  bool adaptive) {
  Sums sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    MapPlane plane;
    if (!map.find(state.T_odom_lidar * (in_sweep(cloud, i, state) * cloud.points[i].cast<double>()), plane)) {
      continue;
    }
    const double e = residual(cloud, i, plane, state);
    if (std::abs(e) > gate_m) {
      continue;
    }
    const double weight = adaptive ? kSigmaM * kSigmaM / (kSigmaM * kSigmaM + e * e) : 1.0;
    Vector12d J;
    for (Eigen::Index c = 0; c < 12; ++c) {
      const Vector12d step = kStep * Vector12d::Unit(c);
      J[c] = (residual(cloud, i, plane, perturbed(state, step)) - residual(cloud, i, plane, perturbed(state, -step))) /
             (2.0 * kStep);
    }
    sums.H += weight * J * J.transpose();
    sums.b += weight * e * J;
    ++sums.count;
  }
  return sums;
}

Matrix6d velocity_hessian(const NormalEquations& sums) { return sums.hessian().bottomRightCorner<6, 6>(); }

struct Scene {
  LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  MotionState state;
  TimedCloud cloud;

  explicit Scene(const Vector6d& velocity) {
    state.T_odom_lidar = se3_exp(twist(0.05, -0.03, 0.4, 0.3, -0.2, 0.1));
    const SE3 truth = state.T_odom_lidar * se3_exp(twist(0.004, -0.003, 0.005, 0.02, 0.03, -0.02));
    cloud = test::measured_in_motion(test::seen_from(truth, test::rimless_room(0.5, 0.37, 1.3)), velocity);
    state.twist = velocity;
  }
};

TEST(PointToPlaneJacobian, PoseAndVelocityAtRest) {
  const Scene scene(Vector6d::Zero());
  const AdaptiveIcpConfig config;
  const NormalEquations sums = linearise(scene.cloud, scene.map, scene.state, kSigmaM, config);
  const Sums numeric = numeric_sums(scene.cloud, scene.map, scene.state, config.gate * kSigmaM, true);
  ASSERT_GT(numeric.count, 200U);
  EXPECT_EQ(sums.count, numeric.count);
  EXPECT_LT((sums.hessian() - numeric.H).norm(), 1e-4 * numeric.H.norm());
  EXPECT_LT((sums.gradient() - numeric.b).norm(), 1e-3 * numeric.b.norm());
  // The velocity's own blocks are small beside the pose's: compared for themselves.
  const Matrix6d velocity_block = numeric.H.bottomRightCorner<6, 6>();
  EXPECT_LT((velocity_hessian(sums) - velocity_block).norm(), 1e-4 * velocity_block.norm());
  EXPECT_LT((sums.gradient().tail<6>() - numeric.b.tail<6>()).norm(), 1e-3 * numeric.b.tail<6>().norm());
}

TEST(PointToPlaneJacobian, PoseIsExactAndVelocityOfFirstOrderInMotion) {
  const Scene scene(twist(0.1, -0.05, 0.6, 3.0, -0.5, 0.2));
  const AdaptiveIcpConfig config;
  const NormalEquations sums = linearise(scene.cloud, scene.map, scene.state, kSigmaM, config);
  const Sums numeric = numeric_sums(scene.cloud, scene.map, scene.state, config.gate * kSigmaM, true);
  ASSERT_GT(numeric.count, 200U);
  const Matrix6d pose_block = numeric.H.topLeftCorner<6, 6>();
  EXPECT_LT((sums.pose_hessian() - pose_block).norm(), 1e-3 * pose_block.norm());
  EXPECT_LT((sums.gradient().head<6>() - numeric.b.head<6>()).norm(), 1e-3 * numeric.b.head<6>().norm());
  const Matrix6d velocity_block = numeric.H.bottomRightCorner<6, 6>();
  EXPECT_LT((velocity_hessian(sums) - velocity_block).norm(), 0.05 * velocity_block.norm());
}

TEST(PointToPlaneJacobian, TheAccelerationChangesWithTheVelocity) {
  Scene scene(Vector6d::Zero());
  scene.state.earlier = {twist(0.05, 0.02, -0.1, 0.3, 0.1, -0.2), 0.1, twist(0.3, -0.2, 0.1, 1.0, 0.5, -0.4), 0.25};
  const AdaptiveIcpConfig config;
  const NormalEquations sums = linearise(scene.cloud, scene.map, scene.state, kSigmaM, config);
  const Sums numeric = numeric_sums(scene.cloud, scene.map, scene.state, config.gate * kSigmaM, true);
  ASSERT_GT(numeric.count, 200U);
  EXPECT_EQ(sums.count, numeric.count);
  EXPECT_LT((sums.hessian() - numeric.H).norm(), 1e-3 * numeric.H.norm());
  const Matrix6d velocity_block = numeric.H.bottomRightCorner<6, 6>();
  EXPECT_LT((velocity_hessian(sums) - velocity_block).norm(), 1e-2 * velocity_block.norm());
  EXPECT_LT((sums.gradient().tail<6>() - numeric.b.tail<6>()).norm(), 1e-2 * numeric.b.tail<6>().norm());
}

TEST(PointToPlaneJacobian, PointsKeepTheirPlanesUntilTheyLeaveTheirVoxels) {
  const Scene scene(twist(0.1, -0.05, 0.6, 3.0, -0.5, 0.2));
  const AdaptiveIcpConfig config;
  PlaneMatches matches;
  const auto kept = [&](const MotionState& state, std::size_t stride) {
    return matches.linearise(scene.cloud, scene.map, state, kSigmaM, config, stride);
  };
  const auto looked_up = [&](const MotionState& state, std::size_t stride) {
    return linearise(scene.cloud, scene.map, state, kSigmaM, config, stride);
  };
  EXPECT_EQ(kept(scene.state, 3).gradient(), looked_up(scene.state, 3).gradient());
  EXPECT_EQ(kept(scene.state, 1).gradient(), looked_up(scene.state, 1).gradient()) << "a third of them is known";
  Vector12d step = Vector12d::Zero();
  step[3] = 0.01;
  const MotionState near = perturbed(scene.state, step);
  EXPECT_TRUE(kept(near, 1).gradient().isApprox(looked_up(near, 1).gradient(), 1e-3));
  step[3] = 1.01 * LocalMapConfig{}.voxel_m;
  const MotionState far = perturbed(scene.state, step);
  EXPECT_EQ(kept(far, 1).gradient(), looked_up(far, 1).gradient()) << "every point has left its voxel";
}

TEST(PointToPlaneJacobian, UnitWeightsWithinAFixedGate) {
  const Scene scene(Vector6d::Zero());
  AdaptiveIcpConfig config;
  config.adaptive = false;
  config.fixed_gate_m = 0.06;
  const NormalEquations sums = linearise(scene.cloud, scene.map, scene.state, kSigmaM, config);
  const Sums numeric = numeric_sums(scene.cloud, scene.map, scene.state, config.fixed_gate_m, false);
  EXPECT_NEAR(static_cast<double>(sums.count), static_cast<double>(numeric.count), 1.0);
  EXPECT_DOUBLE_EQ(sums.weight, static_cast<double>(sums.count));
  EXPECT_LT((sums.gradient() - numeric.b).norm(), 0.01 * numeric.b.norm());
  config.fixed_gate_m = 10.0;
  EXPECT_GT(linearise(scene.cloud, scene.map, scene.state, kSigmaM, config).count, sums.count);
}

TEST(PointToPlaneJacobian, WithoutTimesOrRefinementTheVelocityHasNoShare) {
  Scene scene(Vector6d::Zero());
  AdaptiveIcpConfig config;
  config.refine_motion = false;
  const NormalEquations fixed = linearise(scene.cloud, scene.map, scene.state, kSigmaM, config);
  EXPECT_EQ(fixed.gradient().tail<6>().norm(), 0.0);
  EXPECT_EQ(fixed.hessian().bottomRows<6>().norm(), 0.0);
  scene.cloud.offsets_s.clear();
  const NormalEquations untimed = linearise(scene.cloud, scene.map, scene.state, kSigmaM, {});
  EXPECT_EQ(untimed.gradient().tail<6>().norm(), 0.0);
  EXPECT_LT((untimed.gradient() - fixed.gradient()).norm(), 1e-4 * fixed.gradient().norm());
}

TEST(PointToPlaneJacobian, AStrideLooksAtEveryNthPoint) {
  const Scene scene(Vector6d::Zero());
  TimedCloud third;
  for (std::size_t i = 0; i < scene.cloud.size(); i += 3) {
    third.points.push_back(scene.cloud.points[i]);
    third.offsets_s.push_back(scene.cloud.offsets_s[i]);
  }
  const NormalEquations strided = linearise(scene.cloud, scene.map, scene.state, kSigmaM, {}, 3);
  const NormalEquations picked = linearise(third, scene.map, scene.state, kSigmaM, {});
  EXPECT_EQ(strided.count, picked.count);
  EXPECT_LT((strided.gradient() - picked.gradient()).norm(), 1e-4 * picked.gradient().norm());
}

TEST(PointToPlaneJacobian, HeldMatchesAreKeptWhereverThePointsMove) {
  const Scene scene(Vector6d::Zero());
  constexpr double kWideM = 10.0;
  PlaneMatches matches;
  const std::size_t count = matches.linearise(scene.cloud, scene.map, scene.state, kWideM, {}, 1).count;
  matches.freeze();
  MotionState far = scene.state;
  far.T_odom_lidar.translation() += Eigen::Vector3d(2.0, 2.0, 2.0);
  EXPECT_EQ(matches.linearise(scene.cloud, scene.map, far, kWideM, {}, 1).count, count);
  EXPECT_LT(linearise(scene.cloud, scene.map, far, kWideM, {}).count, count / 2);
}

TEST(Perturbed, MovesAlongTheAxesOfTheOdometryFrame) {
  MotionState state;
  state.T_odom_lidar = se3_exp(twist(0, 0, test::kPi / 2, 0, 0, 0));  // sensor's x is the frame's y
  state.T_odom_lidar.translation() = Eigen::Vector3d(5, 6, 7);
  Vector12d delta = Vector12d::Zero();
  delta << 0, 0, 0.1, 1, 2, 3, 0, 0, 0.2, 0, 4, 0;
  const MotionState moved = perturbed(state, delta);
  EXPECT_TRUE(moved.T_odom_lidar.translation().isApprox(Eigen::Vector3d(6, 8, 10)));  // about the sensor's own origin
  EXPECT_NEAR(rotation_angle_rad(moved.T_odom_lidar), test::kPi / 2 + 0.1, 1e-12);
  EXPECT_TRUE(moved.twist.isApprox(twist(0, 0, 0.2, 4, 0, 0), 1e-12));
  EXPECT_TRUE(perturbed(state, Vector12d::Zero()).T_odom_lidar.isApprox(state.T_odom_lidar));
}

TEST(Perturbed, ThePriorsErrorIsWhatAStateWasMovedBy) {
  MotionPrior prior;
  prior.state.T_odom_lidar = se3_exp(twist(0.3, -0.2, test::kPi / 2, 5, 6, 7));
  prior.state.twist = twist(0.1, 0.2, 0.3, 10, 0, 0);
  Vector12d delta = Vector12d::Zero();
  delta << 0, 0, 0, 1, 2, 3, 0.1, 0.2, 0.3, 4, 5, 6;
  EXPECT_TRUE(prior_error(prior, perturbed(prior.state, delta)).isApprox(delta, 1e-9));
  delta << 0.1, 0.2, 0.3, 1, 2, 3, 0, 0, 0, 0, 0, 0;
  const Vector12d turned = prior_error(prior, perturbed(prior.state, delta));
  EXPECT_TRUE(turned.head<6>().isApprox(delta.head<6>(), 1e-9));
}

TEST(CoarseJacobian, SumsAgreeWithNumericDifferences) {
  CoarseRegistrationConfig config;
  config.density_radius_m = 1.0;
  config.density_percentile = 0.0;
  config.sigma = 1.3;
  const auto world = test::rimless_room(0.6, 0.2);
  const SE3 T_source = se3_exp(twist(0.02, -0.01, 0.05, 0.1, 0.05, -0.05));
  const auto target = make_distribution_cloud(test::seen_from(SE3::Identity(), test::rimless_room(0.6, 0.5)), config);
  const auto source = make_distribution_cloud(test::seen_from(T_source, world), config);
  const SE3 T = T_source * se3_exp(twist(0.01, 0.02, -0.02, 0.05, -0.03, 0.04));
  const double noise_m = 0.3;
  std::vector<std::uint32_t> matches;
  const CoarseSums sums = linearise(source, target, T, noise_m, config, matches);

  CoarseSums numeric;
  for (std::size_t m = 0; m < source.size(); ++m) {
    const Eigen::Vector3d p = source.grid.points()[m].cast<double>();
    std::size_t nearest = 0;
    for (std::size_t n = 1; n < target.size(); ++n) {
      const auto distance = [&](std::size_t k) { return (target.grid.points()[k].cast<double>() - T * p).norm(); };
      nearest = distance(n) < distance(nearest) ? n : nearest;
    }
    const Eigen::Vector3d e = target.grid.points()[nearest].cast<double>() - T * p;
    if (e.norm() > config.max_correspondence_m) {
      continue;
    }
    Eigen::Matrix<double, 3, 6> J;
    for (Eigen::Index c = 0; c < 6; ++c) {
      const Vector6d step = kStep * Vector6d::Unit(c);
      J.col(c) = (se3_exp(step) * T * p - se3_exp(-step) * T * p) / (2.0 * kStep);
    }
    const Eigen::Matrix3d information =
        (T.linear() * source.covariances[m].cast<double>() * T.linear().transpose() +
         target.covariances[nearest].cast<double>() + noise_m * noise_m * Eigen::Matrix3d::Identity())
            .inverse();
    const double w = std::exp(-e.dot(information * e) / (2.0 * config.sigma * config.sigma));
    numeric.H += w * J.transpose() * information * J;
    numeric.b += w * J.transpose() * information * e;
    numeric.weight += w;
    ++numeric.pairs;
  }
  ASSERT_GT(numeric.pairs, 200U);
  EXPECT_EQ(sums.pairs, numeric.pairs);
  EXPECT_NEAR(sums.weight, numeric.weight, 1e-4 * numeric.weight);
  EXPECT_LT((sums.H - numeric.H).norm(), 1e-4 * numeric.H.norm());
  EXPECT_LT((sums.b - numeric.b).norm(), 1e-3 * numeric.b.norm());
}

}  // namespace
}  // namespace rilo
