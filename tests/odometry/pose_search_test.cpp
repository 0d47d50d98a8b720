// A sweep registered from several places: which result is taken, and what is said of the others.
#include "odometry/pose_search.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "odometry/optimum.hpp"
#include "odometry/path_search.hpp"
#include "odometry/registration_stage.hpp"
#include "odometry/second_sweep.hpp"

namespace rilo {
namespace {

constexpr double kSearchPeriodS = 0.1;
constexpr std::int64_t kSearchPeriodNs = 100'000'000;

SE3 along(double x_m) { return SE3(Eigen::Translation3d(x_m, 0.0, 0.0)); }
double x_of(const Registration& found) { return found.icp.state.T_odom_lidar.translation().x(); }

/// Panels beside a road, left and right in turn: so far apart, and as far off that as makes them irregular.
struct Panels {
  double spacing_m = 5.0;
  double sway_m = 1.5;
};
constexpr Panels kIrregular;
constexpr Panels kRegular{2.5, 0.0};
constexpr Panels kNone{1000.0, 500.0};

/// A road between walls; panels show the way. Seen from `x_m` along it, sensor frame.
std::vector<Eigen::Vector3f> road(double x_m, double reach_m, double phase_m, double noise_m, const Panels& panels) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, noise_m + 1e-12);
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](double x, double y, double z) {
    const double dx = noise(rng);
    const double dy = noise(rng);
    points.push_back(Eigen::Vector3d(x - x_m + dx, y + dy, z + noise(rng)).cast<float>());
  };
  for (double x = std::floor(x_m - reach_m) + phase_m; x < x_m + reach_m; x += 0.3) {
    for (double y = -6.0 + phase_m; y < 6.0; y += 0.6) {
      add(x, y, -1.53);
    }
    for (double z = -1.5 + phase_m; z < 1.5; z += 0.3) {
      add(x, -6.03, z);
      add(x, 6.03, z);
    }
  }
  for (int i = -20; i <= 20; ++i) {
    const double panel = panels.spacing_m * i + panels.sway_m * std::sin(1.7 * i + 1.0);
    for (double y = -0.8 + phase_m; y < 0.8 && std::abs(panel - x_m) < reach_m; y += 0.1) {
      for (double z = -0.8 + phase_m; z < 0.8; z += 0.1) {
        add(panel, (i % 2 == 0 ? 4.0 : -4.0) + y, z);
      }
    }
  }
  return points;
}

/// A sensor that comes along that road at 10 m/s and is expected 1 m on.
class PoseSearches : public ::testing::Test {
 protected:
  void map_road(const Panels& panels) {
    LocalMapConfig config;
    config.range_noise_m = 0.0;
    config.angle_noise_rad = 0.0;
    map_ = SweepMap(config);
    const TimedCloud world{road(0.0, 40.0, 0.0, 0.0, panels)};
    map_.begin(world, {}, 8.0, {});
    map_.insert(world, {}, {});
    map_.insert(world, {}, {});
    tracker_.begin({along(-2.0)});
    for (const double x : {-1.0, 0.0}) {
      tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
      tracker_.accept(state_at(x), MotionVerdict::kPossible, false);
    }
    tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
    initial_pose_.keep_target({road(0.0, 20.0, 0.03, 0.01, panels)}, tracker_.trusted().twist);
  }

  static IcpResult state_at(double x) {
    IcpResult icp;
    icp.state.T_odom_lidar = along(x);
    icp.state.twist[3] = 10.0;
    icp.posterior_information.setIdentity();
    return icp;
  }

  void see_road(double x_m, const Panels& panels) {
    prepared_.source.points = prepared_.map_cloud.points = road(x_m, 20.0, 0.07, 0.01, panels);
    prepared_.scene_range_m = 8.0;
  }

  RegistrationContext context() {
    return {.config = config_,
            .prepared = prepared_,
            .tracker = tracker_,
            .map = map_,
            .initial_pose = initial_pose_,
            .pose_by_elevation = still_,
            .sigma_th_m = 0.1,
            .usual_sigma_th_m = 0.1,
            .period_s = kSearchPeriodS};
  }

  MotionState predicted() const { return tracker_.predicted(0.1); }

  Registration at_the_prediction(const RegistrationContext& parts) const {
    return PoseSearch(parts).to_map(predicted(), tracker_.prior(std::nullopt), 0.1, config_.icp, {});
  }

  OdometryConfig config_;
  PreparedSweep prepared_;
  MotionTracker tracker_{{}, {}, {}};
  SweepMap map_{LocalMapConfig{}};
  InitialPoseStage initial_pose_{{}, {}};
  PoseDerivative still_;
};

TEST_F(PoseSearches, QualityIsScoreTimesShareOverDistance) {
  EXPECT_NEAR(quality_of({0.3, 0.02}, 0.8), 0.8 * 0.3 / 0.02, 1e-9);
  EXPECT_EQ(quality_of({0.0, 0.0}, 0.8), 0.0);
}

// A car moves off: the error of the prediction widens the threshold, and points beside the planes count more.
TEST_F(PoseSearches, QualityIsThatOfThePoseWhateverTheThreshold) {
  config_.threshold.narrowing = 1.0;
  map_road(kIrregular);
  see_road(1.0, kIrregular);
  for (std::size_t i = 0; i < prepared_.source.points.size(); i += 4) prepared_.source.points[i].y() += 0.25F;
  const RegistrationContext all = context();
  const auto with = [&](double sigma_th_m) {
    return PoseSearch(all).to_map(predicted(), tracker_.prior(std::nullopt), sigma_th_m, config_.icp, {});
  };
  const Registration narrow = with(0.03);
  const Registration wide = with(0.2);
  EXPECT_GT(wide.icp.residual_rms_m, 2.0 * narrow.icp.residual_rms_m);
  EXPECT_NEAR(wide.quality, narrow.quality, 0.1 * narrow.quality);
}

// What has moved meanwhile draws at the pose while the scale of the weights is wide.
TEST_F(PoseSearches, OnceConvergedTheScaleGoesDownToThatOfTheNoise) {
  map_road(kIrregular);
  see_road(1.0, kIrregular);
  for (std::size_t i = 0; i < prepared_.source.points.size(); i += 4) prepared_.source.points[i].y() += 0.25F;
  const auto found_with = [&](double narrowing, double sigma_th_m) {
    config_.threshold.narrowing = narrowing;
    const RegistrationContext all = context();
    return PoseSearch(all).to_map(predicted(), tracker_.prior(std::nullopt), sigma_th_m, config_.icp, {});
  };
  const auto aside_m = [](const Registration& found) {
    return std::abs(found.icp.state.T_odom_lidar.translation().y());
  };
  const Registration wide = found_with(1.0, 0.4);
  const Registration narrow = found_with(4.0, 0.4);
  EXPECT_EQ(wide.sigma_th_m, 0.4);
  EXPECT_EQ(narrow.sigma_th_m, config_.threshold.floor_m) << "0.4, 0.1, 0.03 m";
  EXPECT_GT(narrow.icp.iterations, wide.icp.iterations);
  EXPECT_GT(aside_m(wide), 0.02);
  EXPECT_LT(aside_m(narrow), 0.3 * aside_m(wide));
  EXPECT_EQ(found_with(4.0, 0.06).sigma_th_m, 0.06) << "half a step is not worth it";
  config_.icp.adaptive = false;
  EXPECT_EQ(found_with(4.0, 0.4).sigma_th_m, 0.4) << "the scale weighs nothing";
}

TEST_F(PoseSearches, ASweepOfAnotherTimeIsFoundOnThePath) {
  map_road(kIrregular);
  see_road(4.0, kIrregular);  // three periods after its stamp
  const RegistrationContext all = context();
  Registration found = at_the_prediction(all);
  ASSERT_GT(std::abs(x_of(found) - 4.0), 1.0);
  PathSearch(all, PoseSearch(all)).improve(predicted(), found);
  EXPECT_NEAR(x_of(found), 4.0, 0.05);
  EXPECT_FALSE(found.ambiguous);
  EXPECT_EQ(found.starts, 2);
}

TEST_F(PoseSearches, ASweepIsAlsoLookedForWhereTheOneBeforeFitted) {
  see_road(12.0, kIrregular);
  for (const bool claimed : {false, true}) {
    map_road(kIrregular);
    tracker_.lose(predicted(), claimed ? std::optional(along(11.0)) : std::nullopt);
    tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
    const RegistrationContext all = context();
    Registration found = at_the_prediction(all);
    ASSERT_LT(x_of(found), 5.0);
    PathSearch(all, PoseSearch(all)).improve(predicted(), found);
    EXPECT_EQ(std::abs(x_of(found) - 12.0) < 0.05, claimed) << "ten periods on is too far on the path";
  }
}

// What the sensor has turned meanwhile hides how much the sweeps have in common, until one is registered.
TEST_F(PoseSearches, AfterALossASweepOfAnotherTimeIsFoundAlthoughTheSensorHasTurned) {
  see_road(4.0, kIrregular);
  const Eigen::Matrix3f turned = so3_exp(Eigen::Vector3d(0.0, 0.0, -0.3)).cast<float>();
  for (auto* points : {&prepared_.source.points, &prepared_.map_cloud.points}) {
    for (Eigen::Vector3f& point : *points) {
      point = turned * point;
    }
  }
  for (const bool lost : {false, true}) {
    map_road(kIrregular);
    if (lost) {
      tracker_.lose(predicted(), std::nullopt);
    }
    const RegistrationContext all = context();
    Registration found = at_the_prediction(all);
    found.icp.state = predicted();
    ASSERT_GT(std::abs(x_of(found) - 4.0), 1.0);
    PathSearch(all, PoseSearch(all)).improve(predicted(), found);
    EXPECT_EQ(std::abs(x_of(found) - 4.0) < 0.05, lost);
    EXPECT_FALSE(found.ambiguous);
  }
}

TEST_F(PoseSearches, WhereItHasMoreInCommonButDoesNotSettleItMayLieAtEitherPlace) {
  map_road(kIrregular);
  see_road(4.0, kIrregular);
  ASSERT_GE(prepared_.source.size(), 4000U) << "one iteration is not of all points";
  config_.icp.max_iterations = 1;
  const RegistrationContext all = context();
  Registration found = at_the_prediction(all);
  const double before = x_of(found);
  PathSearch(all, PoseSearch(all)).improve(predicted(), found);
  EXPECT_TRUE(found.ambiguous);
  EXPECT_EQ(x_of(found), before);
}

TEST_F(PoseSearches, WhereNothingShowsTheWayNoOtherPlaceIsTried) {
  map_road(kNone);
  see_road(1.0, kNone);
  const RegistrationContext all = context();
  for (const double x_m : {1.0, 3.0, 5.0}) {  // wherever it was found
    Registration found = at_the_prediction(all);
    found.icp.state.T_odom_lidar = along(x_m);
    PathSearch(all, PoseSearch(all)).improve(predicted(), found);
    EXPECT_EQ(found.starts, 1) << x_m;
    EXPECT_EQ(x_of(found), x_m);
    EXPECT_FALSE(found.ambiguous);
  }
}

TEST_F(PoseSearches, AfterALossWhatWasFoundHoldsWithinTheUsualGate) {
  config_.threshold.narrowing = 1.0;
  map_road(kIrregular);
  see_road(1.0, kIrregular);
  tracker_.lose(predicted(), std::nullopt);
  RegistrationContext wide = context();
  wide.sigma_th_m = 0.2;
  InitialPose init;
  init.T_odom_lidar = predicted().T_odom_lidar;
  for (const bool contradicted : {false, true}) {
    wide.contradicted = contradicted;
    const Registration found = fine_registration(wide, predicted(), init);
    EXPECT_EQ(found.sigma_th_m, wide.usual_sigma_th_m);
    EXPECT_NEAR(x_of(found), 1.0, 0.05);
    EXPECT_FALSE(found.ambiguous);
  }
}

TEST_F(PoseSearches, WhatMayLieElsewhereStillMayWhenItHolds) {
  map_road(kIrregular);
  see_road(4.0, kIrregular);
  config_.icp.max_iterations = 1;
  initial_pose_.learn(0.9, 1e9);  // nothing fits as usual
  tracker_.lose(predicted(), std::nullopt);
  RegistrationContext all = context();
  all.contradicted = true;
  InitialPose init;
  init.T_odom_lidar = predicted().T_odom_lidar;
  EXPECT_TRUE(fine_registration(all, predicted(), init).ambiguous);
}

// `cut`: a search was due, for which there was no time.
TEST_F(PoseSearches, OtherPlacesAreSearchedWhenADirectionIsNoLongerSeen) {
  const Deadline::Clock clock = [] { return std::int64_t{1}; };
  for (const bool panels : {true, false}) {
    map_road(panels ? kIrregular : kNone);
    see_road(1.0, panels ? kIrregular : kNone);
    RegistrationContext late = context();
    late.deadline = Deadline(clock, 0);
    InitialPose init;
    init.T_odom_lidar = predicted().T_odom_lidar;
    EXPECT_EQ(fine_registration(late, predicted(), init).cut, !panels);
    tracker_.accept(state_at(1.0), MotionVerdict::kPossible, true);
    tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
    EXPECT_FALSE(fine_registration(late, predicted(), init).cut) << "it was not seen before either";
  }
}

/// The second sweep of a map that one sweep began 2.5 m before, from there.
TEST_F(PoseSearches, ASecondSweepThatFitsElsewhereAsWellIsAmbiguous) {
  config_.threshold.floor_m = 0.01;
  for (const Panels& panels : {kIrregular, kRegular}) {
    map_ = SweepMap(config_.map);
    map_.begin({road(0.0, 40.0, 0.0, 0.01, panels)}, {}, 8.0, {});
    tracker_.reset();
    tracker_.begin({});
    tracker_.advance({0, kSearchPeriodNs, kSearchPeriodNs});
    prepared_.source.points = road(2.5, 40.0, 0.07, 0.01, panels);
    prepared_.map_cloud = prepared_.source;
    prepared_.scene_range_m = 8.0;
    const RegistrationContext all = context();
    const MotionState at_rest;
    const Registration found = SecondSweep(all, PoseSearch(all)).registered(at_rest, tracker_.prior(at_rest));
    const bool regular = panels.sway_m == 0.0;  // one step back looks like one step on
    EXPECT_EQ(found.ambiguous, regular);
    EXPECT_NEAR(regular ? std::abs(x_of(found)) : x_of(found), 2.5, 0.05);
    EXPECT_DOUBLE_EQ(found.sigma_th_m, 0.0125) << "halved three times, from round to round";
  }
}

}  // namespace
}  // namespace rilo
