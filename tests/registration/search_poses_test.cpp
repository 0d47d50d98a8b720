// The search over poses by map score.
#include <array>
#include <atomic>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "registration/map_score.hpp"
#include "registration/pose_grid.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

using test::twist;

TEST(SearchPoses, FindsAKnownShiftAndTurn) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  SE3 centre = se3_exp(twist(0, 0, 0.3, 0, 0, 0));
  centre.translation() = Eigen::Vector3d(0.4, -0.2, 0.0);
  const SE3 truth = centre * se3_exp(twist(0, 0, 0.2, 0, 0, 0));
  SE3 shifted = truth;
  shifted.translation() = centre * Eigen::Vector3d(1.0, -0.5, 0.0);
  const auto points = test::seen_from(shifted, test::rimless_room(0.6, 0.3, 1.2));
  const PoseGrid grid{1.5, 0.5, 0.4, 0.1};
  const auto best = search_poses(points, map, centre, grid, 0.2, 3);
  ASSERT_EQ(best.size(), 3U);
  EXPECT_LT(test::distance_m(best[0], shifted), 1e-9);
  EXPECT_LT(test::angle_deg(best[0], shifted), 1e-6);
  EXPECT_GE(map_score(points, map, best[0], 0.2), map_score(points, map, best[1], 0.2));
  EXPECT_GE(map_score(points, map, best[1], 0.2), map_score(points, map, best[2], 0.2));
  for (std::size_t i = 1; i < best.size(); ++i) {
    EXPECT_TRUE(test::distance_m(best[0], best[i]) > 0.9 || test::angle_deg(best[0], best[i]) > 15.0);
  }
}

TEST(SearchPoses, AFullTurnClosesTheCircle) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  const SE3 turned = se3_exp(twist(0, 0, 3.13, 0, 0, 0));
  const auto points = test::seen_from(turned, test::rimless_room(0.6, 0.3, 1.2));
  const auto best = search_poses(points, map, SE3::Identity(), {0.5, 0.5, 3.1, 0.1}, 0.2, 4);
  ASSERT_EQ(best.size(), 4U);
  for (std::size_t i = 0; i < best.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_TRUE(test::distance_m(best[i], best[k]) > 0.9 || test::angle_deg(best[i], best[k]) > 11.0)
          << i << " " << k;
    }
  }
}

TEST(SearchPoses, ReachesTheRim) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  for (const auto& [steps, x, y] : {std::array{10, 8, 6}, std::array{16, -11, 11}, std::array{13, 5, -12}}) {
    SE3 rim = SE3::Identity();
    rim.translation() = 0.1 * Eigen::Vector3d(x, y, 0.0);
    const auto points = test::seen_from(rim, test::rimless_room(0.6, 0.3, 1.2));
    const auto best = search_poses(points, map, SE3::Identity(), {0.1 * steps, 0.1, 0.0, 0.1}, 0.1, 1);
    ASSERT_EQ(best.size(), 1U);
    EXPECT_LT(test::distance_m(best[0], rim), 1e-9) << steps;
  }
}

TEST(SearchPoses, OfAWideGridFewNodesAreScored) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  const PoseGrid grid{8.0, 0.5, 1.6, 0.1};  // not half a turn, which a room allows
  SE3 seen = SE3::Identity();
  seen.translation() = Eigen::Vector3d(0.5, -1.0, 0.0);
  const auto points = test::seen_from(seen, test::rimless_room(0.6, 0.3, 1.2));
  const SE3 centre = seen * se3_exp(twist(0, 0, 0, -6.5, 4.0, 0)) * se3_exp(twist(0, 0, -1.0, 0, 0, 0));
  std::atomic<std::int64_t> scored = 0;
  const Deadline::Clock counting = [&] { return ++scored; };
  const std::int64_t never = std::numeric_limits<std::int64_t>::max();
  const auto best = search_poses(points, map, centre, grid, 0.3, 4, Deadline(counting, never));
  ASSERT_FALSE(best.empty());
  EXPECT_LT(test::distance_m(best[0], seen), 0.36);  // half a step along both axes
  EXPECT_LT(test::angle_deg(best[0], seen), 3.0);
  const std::int64_t nodes = 797 * 33;  // shifts within 16 steps, turns
  EXPECT_LT(scored, nodes / 8);
}

TEST(SearchPoses, AfterTheDeadlineOnlyTheNearestWereScored) {
  const LocalMap map = test::map_of(test::rimless_room(0.13, 0.0));
  const auto points = test::seen_from(SE3::Identity(), test::rimless_room(0.6, 0.3, 1.2));
  const PoseGrid grid{6.0, 0.5, 1.0, 0.1};
  std::atomic<std::int64_t> now_ns = 0;
  const Deadline::Clock clock = [&] { return ++now_ns; };
  EXPECT_TRUE(search_poses(points, map, SE3::Identity(), grid, 0.2, 3, Deadline(clock, 0)).empty());
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto best = search_poses(points, map, SE3::Identity(), grid, 0.2, 3, Deadline(clock, now_ns + 6));
  ASSERT_FALSE(best.empty());
  for (const SE3& T : best) {
    EXPECT_LT(T.translation().norm(), 1.6);  // three steps
  }
}

TEST(SearchPoses, WithoutEvidenceTheSmallestMotionComesFirst) {
  const LocalMap empty{LocalMapConfig{}};
  const SE3 centre = se3_exp(twist(0, 0, 1, 2, 3, 4));
  const auto best = search_poses({}, empty, centre, {1.0, 0.5, 0.2, 0.1}, 0.2, 1);
  ASSERT_EQ(best.size(), 1U);
  EXPECT_TRUE(best[0].isApprox(centre));
  EXPECT_TRUE(search_poses({}, empty, centre, {}, 0.2, 0).empty());
}

TEST(SearchPoses, LiesInACircleAndFartherApartThanTwoSteps) {
  const LocalMap empty{LocalMapConfig{}};
  const PoseGrid grid{2.0, 0.5, 0.3, 0.1};
  const auto poses = search_poses({{1, 0, 0}}, empty, SE3::Identity(), grid, 0.2, 1000);
  ASSERT_GT(poses.size(), 10U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LE(poses[i].translation().norm(), 2.0 + 1e-9);
    for (std::size_t k = 0; k < i; ++k) {
      const SE3 between = poses[k].inverse() * poses[i];
      const Eigen::Vector3d shift = poses[i].translation() - poses[k].translation();
      EXPECT_TRUE(shift.cwiseAbs().maxCoeff() > 1.01 || rotation_angle_rad(between) > 0.21) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace rilo
