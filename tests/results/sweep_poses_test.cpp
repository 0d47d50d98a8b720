// Poses of sweeps by stamp and by index, and the motion during a sweep, by hand.
#include "results/sweep_poses.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "results/sweep_times.hpp"
#include "rilo/session/session.hpp"

namespace rilo {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// A sensor that looks and drives to the left: 0, 1, 3, 6 and 10 m.
PoseFile accelerating(const std::vector<std::int64_t>& stamps_ms) {
  PoseFile file;
  file.stamped = !stamps_ms.empty();
  for (std::size_t i = 0; i < 5; ++i) {
    StampedPose pose;
    pose.stamp_ns = file.stamped ? stamps_ms.at(i) * kMs : 0;
    pose.T_odom_lidar = SE3(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
    pose.T_odom_lidar.translation().y() = 0.5 * static_cast<double>(i * (i + 1));
    file.trajectory.push_back(pose);
  }
  return file;
}

double speed_m_s(const std::optional<SweepPose>& pose) {
  if (!pose) return -1;
  EXPECT_LT(pose->twist.head<4>().cwiseAbs().head<3>().maxCoeff(), 1e-9);
  EXPECT_LT(pose->twist.tail<2>().norm(), 1e-9);
  return pose->twist(3);
}

TEST(SweepPoses, ByStampTheNearestWithinTheGap) {
  const SweepPoses poses(accelerating({0, 100, 200, 300, 400}), {Pairing::kAuto, 0.05, 0});
  const auto at = [&](std::int64_t middle_ns) { return poses.of({9, middle_ns, {}, {}}, 0.1); };
  EXPECT_NEAR(speed_m_s(at(100 * kMs)), 3 / 0.2, 1e-9);
  EXPECT_NEAR(speed_m_s(at(0)), 1 / 0.1, 1e-9);
  EXPECT_NEAR(speed_m_s(at(400 * kMs)), 4 / 0.1, 1e-9);
  EXPECT_EQ(at(150 * kMs)->T.translation().y(), 1);  // the earlier of two
  EXPECT_EQ(at(150 * kMs + 1)->T.translation().y(), 3);
  EXPECT_EQ(at(450 * kMs)->T.translation().y(), 10);
  EXPECT_FALSE(at(450 * kMs + 1));
  EXPECT_FALSE(at(-50 * kMs - 1));
}

TEST(SweepPoses, StampsThatAreFarApartDoNotWrapAround) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  PoseFile file = accelerating({0, 100, 200, 300, 400});
  file.trajectory.resize(2);
  file.trajectory[0].stamp_ns = kMin + 1;
  file.trajectory[1].stamp_ns = kMin + 2;
  EXPECT_FALSE(SweepPoses(file, {}).of({9, kMax, {}, {}}, 0.1));
  file.trajectory[1].stamp_ns = kMax;
  EXPECT_EQ(SweepPoses(file, {}).of({9, kMax - 5, {}, {}}, 0.1)->T.translation().y(), 1);
}

TEST(SweepPoses, ByIndexWithTheTimesOfTheSweeps) {
  const SweepPoses poses(accelerating({}), {});
  const auto at = [&](std::size_t index, std::optional<std::int64_t> before_ms, std::optional<std::int64_t> after_ms) {
    const auto ns = [](std::optional<std::int64_t> ms) { return ms ? std::optional(*ms * kMs) : std::nullopt; };
    return poses.of({index, 100 * kMs, ns(before_ms), ns(after_ms)}, 0.1);
  };
  EXPECT_NEAR(speed_m_s(at(1, 0, 300)), 3 / 0.3, 1e-9);  // a sweep was not read
  EXPECT_NEAR(speed_m_s(at(1, {}, 200)), 2 / 0.1, 1e-9);
  EXPECT_NEAR(speed_m_s(at(1, 0, {})), 1 / 0.1, 1e-9);
  EXPECT_EQ(speed_m_s(at(1, {}, {})), 0);
  EXPECT_NEAR(speed_m_s(at(0, 0, 200)), 1 / 0.1, 1e-9);
  EXPECT_NEAR(speed_m_s(at(4, 0, 200)), 4 / 0.1, 1e-9);
  EXPECT_NEAR(speed_m_s(at(1, 100, 100)), 3 / 0.2, 1e-9);  // stamps that stand still: by the period
  EXPECT_FALSE(at(5, 0, 200));
}

TEST(SweepPoses, StampsThatDoNotIncreaseAreOfNoUse) {
  const PoseFile file = accelerating({0, 100, 100, 200, 300});
  EXPECT_THROW(SweepPoses(file, {}), RunError);
  const SweepPoses by_index(file, {Pairing::kIndex, 0.02, 0});
  EXPECT_EQ(by_index.of({2, 0, {}, {}}, 0.1)->T.translation().y(), 3);
  EXPECT_THROW(SweepPoses(accelerating({}), {Pairing::kStamp, 0.02, 0}), RunError);
}

TEST(SweepPoses, PointsAreMovedToTheMiddleOfTheSweep) {
  Sweep sweep;
  sweep.points.assign(4, {1, 0, 0});
  SweepPose pose;
  pose.twist(3) = 10;
  EXPECT_EQ(points_at(sweep, pose), sweep.points);
  sweep.stamp_ns = 7 * kMs;
  sweep.times_s = {std::numeric_limits<float>::quiet_NaN(), 0.02F, 0.12F, 0.07F};
  EXPECT_EQ(middle_ns(sweep), 77 * kMs);
  const auto points = points_at(sweep, pose);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_TRUE(std::isnan(points[0].x()));
  EXPECT_NEAR(points[1].x(), 0.5, 1e-6);
  EXPECT_NEAR(points[2].x(), 1.5, 1e-6);
  EXPECT_NEAR(points[3].x(), 1, 1e-6);
  EXPECT_EQ(instant_s(sweep.times_s, PoseInstant::kStart), 0.02F);
  EXPECT_EQ(instant_s(sweep.times_s, PoseInstant::kEnd), 0.12F);
}

}  // namespace
}  // namespace rilo
