// A sweep registered from several places: which result is taken, and what is said of the others.
#include "odometry/pose_search.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "odometry/optimum.hpp"
#include "odometry/registration_stage.hpp"
#include "odometry/second_sweep.hpp"
#include "road_with_panels.hpp"

namespace rilo {
namespace {

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

// What was found must then hold within the usual gate, which takes time, too.
TEST_F(PoseSearches, ASearchAfterALossTakesSevenTenthsOfTheTime) {
  const Deadline::Clock clock = [] { return std::int64_t{0}; };
  map_road(kIrregular);
  RegistrationContext all = context();
  all.deadline = Deadline(clock, 100'000'000);
  EXPECT_FALSE(PoseSearch(all).end().passed_after(99.0));
  tracker_.lose(predicted(), std::nullopt);
  EXPECT_FALSE(PoseSearch(all).end().passed_after(69.0));
  EXPECT_TRUE(PoseSearch(all).end().passed_after(71.0));
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

// Too near the prediction to be of another time, too far for the usual gate.
TEST_F(PoseSearches, ASensorThatBrakesIsFoundFromRestWithinTheGateOfTheBeginning) {
  map_road(kIrregular);
  see_road(0.6, kIrregular);
  initial_pose_.learn(0.9, 1e9);  // nothing fits as usual
  RegistrationContext narrow = context();
  narrow.sigma_th_m = narrow.usual_sigma_th_m = 0.03;
  InitialPose init;
  init.T_odom_lidar = predicted().T_odom_lidar;
  const Registration from_prediction =
      PoseSearch(narrow).to_map(predicted(), tracker_.prior(std::nullopt), 0.03, config_.icp, {});
  ASSERT_GT(x_of(from_prediction), 0.8);
  const Registration found = fine_registration(narrow, predicted(), init);
  EXPECT_NEAR(x_of(found), 0.6, 0.02);
  EXPECT_EQ(found.starts, 2);
  EXPECT_EQ(found.sigma_th_m, config_.threshold.floor_m);
  EXPECT_FALSE(found.ambiguous);
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
