// Whether the map shows a sweep at a pose rather than a metre beside it, counted by hand.
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "registration/map_score.hpp"
#include "registration/registration_scenes.hpp"

namespace rilo {
namespace {

constexpr double kScoreSigmaM = 0.2;
constexpr double kPatchSpacingM = 4.0;
constexpr int kPatchRows = 20;
const std::array<Eigen::Vector3f, 4> kWays = {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(-1, 0, 0),
                                              Eigen::Vector3f(0, 1, 0), Eigen::Vector3f(0, -1, 0)};

/// Small horizontal patches 4 m apart, each within one voxel: a metre beside one there is nothing.
LocalMap map_of_patches() {
  std::vector<Eigen::Vector3d> world;
  for (int i = 0; i < kPatchRows; ++i) {
    for (int j = 0; j < kPatchRows; ++j) {
      for (int k = 0; k < 5; ++k) {
        for (int l = 0; l < 5; ++l) {
          world.emplace_back(kPatchSpacingM * i + 0.05 + 0.1 * k, kPatchSpacingM * j + 0.05 + 0.1 * l, 0.25);
        }
      }
    }
  }
  return test::map_of(world);
}

/// The first `count` patches' middles, moved by `by`.
void add_patches(std::vector<Eigen::Vector3f>& points, int count, const Eigen::Vector3f& by) {
  for (int n = 0; n < count; ++n) {
    const int i = n / kPatchRows;
    const int j = n % kPatchRows;
    const Eigen::Vector3d middle(kPatchSpacingM * i + 0.25, kPatchSpacingM * j + 0.25, 0.25);
    points.emplace_back(middle.cast<float>() + by);
  }
}

/// `here` points on patches, and for each of the four places beside the pose but `but` `beside` points that would be on
/// patches there.
std::vector<Eigen::Vector3f> patch_sweep(int here, int beside, const Eigen::Vector3f& but = Eigen::Vector3f::Zero()) {
  std::vector<Eigen::Vector3f> points;
  add_patches(points, here, Eigen::Vector3f::Zero());
  for (const Eigen::Vector3f& way : kWays) {
    add_patches(points, way == but ? 0 : beside, -way);
  }
  return points;
}

TEST(StandsOut, WhatSpeaksForThePoseIsTwiceWhatSpeaksForAPlaceBesideIt) {
  const LocalMap map = map_of_patches();
  EXPECT_TRUE(stands_out(patch_sweep(101, 50), map, SE3::Identity(), kScoreSigmaM));
  EXPECT_FALSE(stands_out(patch_sweep(99, 50), map, SE3::Identity(), kScoreSigmaM));
  EXPECT_FALSE(stands_out(patch_sweep(0, 50), map, SE3::Identity(), kScoreSigmaM));
}

TEST(StandsOut, OverOneOfThePlacesIsEnough) {
  const LocalMap map = map_of_patches();
  for (const Eigen::Vector3f& way : kWays) {
    EXPECT_TRUE(stands_out(patch_sweep(60, 50, way), map, SE3::Identity(), kScoreSigmaM)) << way.transpose();
  }
}

TEST(StandsOut, ThePlacesAreBesideTheSensorWhereverItLooks) {
  const LocalMap map = map_of_patches();
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, 0.5 * test::kPi));
  T.translation() = Eigen::Vector3d(3.0, -2.0, 0.5);
  const auto seen = [&](int here) {
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3f& p : patch_sweep(here, 50)) {
      points.push_back((T.inverse() * p.cast<double>()).cast<float>());
    }
    return points;
  };
  EXPECT_TRUE(stands_out(seen(101), map, T, kScoreSigmaM));
  EXPECT_FALSE(stands_out(seen(99), map, T, kScoreSigmaM));
}

// Open ground explains the same points everywhere; the few that tell places apart are chance.
TEST(StandsOut, LittleThatSpeaksForOtherPlacesDoesNotCount) {
  std::vector<Eigen::Vector3d> ground;
  for (double x = -6.0; x < 6.0; x += 0.1) {
    for (double y = -6.0; y < 6.0; y += 0.1) {
      ground.emplace_back(x, y, -1.05);
    }
  }
  const LocalMap map = test::map_of(ground);
  // 1600 points that the ground explains everywhere, and some beyond each edge that it explains at one place beside.
  const auto seen = [](int beyond) {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 40; ++i) {
      for (int j = 0; j < 40; ++j) {
        points.emplace_back(-4.0F + 0.2F * static_cast<float>(i), -4.0F + 0.2F * static_cast<float>(j), -1.05F);
      }
    }
    for (const Eigen::Vector3f& way : kWays) {
      for (int i = 0; i < beyond; ++i) {
        const Eigen::Vector3f along(way.y(), way.x(), 0.0F);
        points.push_back(6.6F * way + (-4.0F + 0.03F * static_cast<float>(i)) * along +
                         Eigen::Vector3f(0.0F, 0.0F, -1.05F));
      }
    }
    return points;
  };
  EXPECT_TRUE(stands_out(seen(0), map, SE3::Identity(), kScoreSigmaM));
  EXPECT_TRUE(stands_out(seen(195), map, SE3::Identity(), kScoreSigmaM)) << "less than an eighth of the score";
  EXPECT_FALSE(stands_out(seen(205), map, SE3::Identity(), kScoreSigmaM));
}

TEST(StandsOut, NothingToCompareIsNoReasonAgainst) {
  EXPECT_TRUE(stands_out({}, map_of_patches(), SE3::Identity(), kScoreSigmaM));
  EXPECT_TRUE(stands_out({{1, 2, 3}}, LocalMap(LocalMapConfig{}), SE3::Identity(), kScoreSigmaM));
}

}  // namespace
}  // namespace rilo
