// Every Jacobian against numeric differentiation, and the registrations on scenes with known answers.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "registration/adaptive_icp.hpp"
#include "registration/coarse_registration.hpp"
#include "registration/degeneracy.hpp"
#include "registration/registration_scenes.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::twist;

SE3 pose(const Vector6d& xi) { return se3_exp(xi); }

LocalMap room_map() {
  LocalMapConfig config;
  LocalMap map(config);
  map.set_scene_range(6.0);
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  map.insert(make_box_room({9.3, 7.1, 3.3}, sampling), SE3::Identity());
  return map;
}

TimedCloud room_source(const SE3& T_world_sensor, std::uint64_t seed) {
  SceneSampling sampling;
  sampling.spacing_m = 0.15;
  sampling.seed = seed;
  sampling.T_world_sensor = T_world_sensor;
  return {make_box_room({9.3, 7.1, 3.3}, sampling), {}};
}

/// Moves what the sensor sees at the reference instant to where it is seen at each point's own instant.
void distort(TimedCloud& cloud, const Vector6d& velocity) {
  const std::size_t n = cloud.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float offset = -0.05F + 0.1F * static_cast<float>((i * 7919) % n) / static_cast<float>(n);
    const SE3 T = se3_exp(velocity * static_cast<double>(offset));
    cloud.points[i] = (T.inverse() * cloud.points[i].cast<double>()).cast<float>();
    cloud.offsets_s.push_back(offset);
  }
}

/// Half the sum of squares at `state` with the plane of each point held: unit weights, wide gate.
double cost(const TimedCloud& source, const LocalMap& map, const MotionState& state, const AdaptiveIcpConfig& config) {
  return 0.5 * linearise(source, map, state, 1.0, config).squared_error;
}

TEST(Jacobian, PoseAndVelocityGradientsAgreeWithDifferences) {
  const LocalMap map = room_map();
  MotionState state;
  state.T_odom_lidar = pose(twist(0.01, -0.02, 0.2, 0.3, -0.2, 0.1));
  state.twist = twist(0.1, 0.05, 0.4, 1.0, -0.5, 0.2);
  TimedCloud source = room_source(state.T_odom_lidar, 3);
  distort(source, state.twist);
  // Points near the edges of voxels change their plane under a small motion: they are left out.
  AdaptiveIcpConfig config;
  config.adaptive = false;
  config.fixed_gate_m = 10.0;
  const MotionState moved = perturbed(state, 2e-3 * Vector12d::Ones());
  const NormalEquations sums = linearise(source, map, moved, 1.0, config);
  const Vector12d gradient = sums.gradient();
  const double h = 1e-7;
  for (Eigen::Index i = 0; i < 12; ++i) {
    const Vector12d step = h * Vector12d::Unit(i);
    const double numeric =
        (cost(source, map, perturbed(moved, step), config) - cost(source, map, perturbed(moved, -step), config)) /
        (2 * h);
    EXPECT_NEAR(gradient[i], numeric, 0.02 * gradient.head<6>().norm() + 1e-3) << "component " << i;
  }
}

TEST(Jacobian, CoarseStepIsTheGradientOfTheMahalanobisCost) {
  CoarseRegistrationConfig config;
  config.sigma = 1e6;  // weights are one: their derivative is no part of Gauss-Newton
  config.voxel_m = 0.3;
  const auto points = room_source(SE3::Identity(), 5).points;
  const DistributionCloud target = make_distribution_cloud(points, config);
  const DistributionCloud& source = target;
  const SE3 T = pose(twist(2e-5, -3e-5, 4e-5, 1e-4, 1.2e-4, -8e-5));
  std::vector<std::uint32_t> matches;
  const CoarseSums sums = linearise(source, target, T, 0.3, config, matches);
  const auto half_cost = [&](const SE3& at) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i) {
      // Small motions keep each point nearest to itself.
      const Eigen::Vector3d e = target.grid.points()[i].cast<double>() - at * source.grid.points()[i].cast<double>();
      const Eigen::Matrix3d M = T.linear() * source.covariances[i].cast<double>() * T.linear().transpose() +
                                target.covariances[i].cast<double>() + 0.09 * Eigen::Matrix3d::Identity();
      sum += 0.5 * e.dot(M.inverse() * e);
    }
    return sum;
  };
  const double h = 1e-6;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Vector6d step = h * Vector6d::Unit(i);
    const double numeric = (half_cost(se3_exp(step) * T) - half_cost(se3_exp(-step) * T)) / (2 * h);
    EXPECT_NEAR(-sums.b[i], numeric, 1e-3 * sums.b.norm()) << "component " << i;
  }
}

TEST(AdaptiveIcp, RecoversAKnownPose) {
  const LocalMap map = room_map();
  const SE3 truth = pose(twist(0.01, -0.01, 0.03, 0.1, -0.08, 0.05));
  MotionState initial;
  const IcpResult result = adaptive_icp(room_source(truth, 9), map, initial, {}, 0.3, {});
  const SE3 error = truth.inverse() * result.state.T_odom_lidar;
  EXPECT_TRUE(result.converged());
  EXPECT_LT(error.translation().norm(), 5e-3);
  EXPECT_LT(rotation_angle_rad(error), 1e-3);
}

TEST(AdaptiveIcp, RecoversTheVelocityDuringTheSweep) {
  const LocalMap map = room_map();
  MotionState truth;
  truth.T_odom_lidar = pose(twist(0.0, 0.0, 0.02, 0.05, 0.02, 0.0));
  truth.twist = twist(0.05, -0.1, 0.6, 1.5, -0.4, 0.1);
  TimedCloud source = room_source(truth.T_odom_lidar, 11);
  distort(source, truth.twist);
  const IcpResult result = adaptive_icp(source, map, {}, {}, 0.3, {});
  EXPECT_LT((result.state.twist - truth.twist).norm(), 0.03);
  EXPECT_LT((truth.T_odom_lidar.inverse() * result.state.T_odom_lidar).translation().norm(), 5e-3);
}

TEST(AdaptiveIcp, EmptyOnePointAndCollinearCloudsStayFiniteAndSayLittle) {
  const LocalMap map = room_map();
  TimedCloud line;
  for (int i = 0; i < 100; ++i) {
    line.points.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  }
  for (const TimedCloud& cloud : {TimedCloud{}, TimedCloud{{Eigen::Vector3f(1, 1, 1)}, {}}, line}) {
    const IcpResult result = adaptive_icp(cloud, map, {}, {}, 0.3, {});
    // Points on a line may settle, but not in all directions.
    EXPECT_TRUE(!result.converged() || result.degeneracy.relative_eigenvalues[0] < 1e-6);
    EXPECT_TRUE(result.state.T_odom_lidar.matrix().allFinite());
  }
}

TEST(AdaptiveIcp, APriorHoldsTheAxisOfACorridor) {
  LocalMapConfig map_config;  // points without noise, and planes alone
  map_config.range_noise_m = 0.0;
  map_config.angle_noise_rad = 0.0;
  map_config.scatter_voxel_m = 0.0;
  LocalMap map(map_config);
  map.set_scene_range(8.0);
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  map.insert(make_corridor(30.0, 3.1, 2.7, sampling), SE3::Identity());
  sampling.seed = 2;
  sampling.spacing_m = 0.15;
  const TimedCloud source{make_corridor(20.0, 3.1, 2.7, sampling), {}};
  MotionPrior prior;
  prior.state.T_odom_lidar.translation().x() = 0.7;
  prior.information = 1e3 * Matrix12d::Identity();
  const IcpResult result = adaptive_icp(source, map, prior.state, prior, 0.3, {});
  EXPECT_NEAR(result.state.T_odom_lidar.translation().x(), 0.7, 1e-2);
  EXPECT_NEAR(result.state.T_odom_lidar.translation().y(), 0.0, 1e-2);
  EXPECT_LT(result.degeneracy.relative_eigenvalues[0], 1e-3);
}

TEST(CoarseRegistration, RecoversAKnownMotion) {
  CoarseRegistrationConfig config;
  config.voxel_m = 0.3;
  config.density_radius_m = 0.5;
  const DistributionCloud target = make_distribution_cloud(room_source(SE3::Identity(), 1).points, config);
  const SE3 truth = pose(twist(0.0, 0.0, 0.15, 0.4, -0.3, 0.05));
  const DistributionCloud source = make_distribution_cloud(room_source(truth, 2).points, config);
  const CoarseResult result = coarse_registration(source, target, SE3::Identity(), config);
  const SE3 error = truth.inverse() * result.T_target_source;
  EXPECT_LT(error.translation().norm(), 0.05);
  EXPECT_LT(rotation_angle_rad(error), 0.02);
}

/// Points on a few squares at random places, with 5 cm of noise. `run`: of the points and the noise.
std::vector<Eigen::Vector3d> scraps(unsigned seed, int squares, unsigned run) {
  std::mt19937 places(seed);
  std::mt19937 rng(run);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  std::uniform_real_distribution<double> side(-0.5, 0.5);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::vector<Eigen::Vector3d> points;
  for (int square = 0; square < squares; ++square) {
    const auto draw = [](auto& from, auto& generator) {
      const double x = from(generator);
      const double y = from(generator);
      return Eigen::Vector3d(x, y, from(generator));
    };
    const Eigen::Vector3d centre = draw(place, places).cwiseProduct(Eigen::Vector3d(1.0, 1.0, 0.3));
    const Eigen::Vector3d a = draw(place, places).normalized();
    const Eigen::Vector3d b = a.unitOrthogonal();
    for (int i = 0; i < 60; ++i) {
      const double u = side(rng);
      const double v = side(rng);
      points.push_back(centre + u * a + v * b + draw(noise, rng));
    }
  }
  return points;
}

// Few points that change planes at every step keep some of these sweeps oscillating: held, they let them come to rest.
TEST(AdaptiveIcp, WithHeldMatchesItComesToRest) {
  int held = 0;
  for (const unsigned seed : {331U, 434U, 498U}) {
    for (const int squares : {2, 3, 4}) {
      LocalMapConfig map_config;
      map_config.voxel_m = 0.25;
      map_config.levels = 3;
      LocalMap map(map_config);
      map.set_scene_range(6.0);
      map.insert(test::seen_from(SE3::Identity(), scraps(seed, squares, 2 * seed)), SE3::Identity());
      const SE3 T = pose(twist(0.01, -0.01, 0.02, 0.1, -0.05, 0.04));
      const TimedCloud source{test::seen_from(T, scraps(seed, squares, 2 * seed + 1)), {}};
      AdaptiveIcpConfig config;
      config.max_iterations = 40;
      for (const double sigma_m : {0.3, 0.4, 0.5, 0.7}) {
        const IcpResult result = adaptive_icp(source, map, {}, {}, sigma_m, config);
        held += result.frozen ? 1 : 0;
        EXPECT_TRUE(result.converged() || !result.frozen) << seed << ' ' << squares << ' ' << sigma_m;
      }
    }
  }
  EXPECT_GT(held, 0);
}

TEST(CoarseRegistration, EmptyCloudsDoNotConverge) {
  const CoarseRegistrationConfig config;
  const DistributionCloud empty = make_distribution_cloud({}, config);
  const CoarseResult result = coarse_registration(empty, empty, SE3::Identity(), config);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.pairs, 0U);
}

TEST(Degeneracy, SoftSelectionFadesTheWeakDirectionOnly) {
  Matrix6d H = Matrix6d::Identity();
  H(3, 3) = 1e-6;
  const PoseDegeneracy d = analyse_degeneracy(H);
  EXPECT_LT(d.relative_eigenvalues[0], 1e-5);
  const Matrix6d W = soft_selection(d, 1e-3);
  const Matrix6d selected = W.transpose() * H * W;
  EXPECT_LT(selected(3, 3), 1e-12);
  EXPECT_NEAR(selected(4, 4), 1.0, 1e-9);
  EXPECT_NEAR(selected(0, 0), 1.0, 1e-9);
  EXPECT_TRUE(soft_selection(d, 0.0).isIdentity());
}

}  // namespace
}  // namespace rilo
