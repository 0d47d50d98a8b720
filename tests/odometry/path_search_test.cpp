// A sweep of another time, looked for along the path.
#include "odometry/path_search.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "road_with_panels.hpp"

namespace rilo {
namespace {

using PathSearches = PoseSearches;

TEST_F(PathSearches, ASweepOfAnotherTimeIsFoundOnThePath) {
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

TEST_F(PathSearches, ASweepIsAlsoLookedForWhereTheOneBeforeFitted) {
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
TEST_F(PathSearches, AfterALossASweepOfAnotherTimeIsFoundAlthoughTheSensorHasTurned) {
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

TEST_F(PathSearches, WhereItHasMoreInCommonButDoesNotSettleItMayLieAtEitherPlace) {
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

TEST_F(PathSearches, WhereNothingShowsTheWayNoOtherPlaceIsTried) {
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

}  // namespace
}  // namespace rilo
