#include "rilo/evaluation/kitti_error.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "evaluation/trajectories.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo::test {
namespace {

std::vector<SE3> scaled(std::vector<SE3> poses, double scale) {
  for (SE3& T : poses) T.translation() *= scale;
  return poses;
}

// One pose a metre over 1000 m, 1 % too long: every segment is 1 % too long, no rotation error.
TEST(KittiError, OnePercentOfScale) {
  const std::vector<SE3> truth = straight_line(1001, 1.0);
  const KittiError error = kitti_error(truth, scaled(truth, 1.01));
  EXPECT_NEAR(error.t_rel_pct().value(), 1.0, 1e-9);
  EXPECT_NEAR(error.r_rel_deg_100m().value(), 0.0, 1e-9);
  EXPECT_FALSE(error.short_path);
  // Starts 0, 10, 20 …; a segment of L metres fits 1000 m while start + L <= 1000.
  std::size_t expected = 0;
  for (int k = 1; k <= 8; ++k) expected += static_cast<std::size_t>((1000 - 100 * k) / 10 + 1);
  EXPECT_EQ(error.segments.size(), expected);
  const std::vector<KittiLengthError> rows = error.per_length();
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_EQ(rows[0].length_m, 100.0);
  EXPECT_EQ(rows[0].count, 91U);
  EXPECT_EQ(rows[7].length_m, 800.0);
  EXPECT_EQ(rows[7].count, 21U);
  for (const KittiLengthError& row : rows) EXPECT_NEAR(row.t_rel_pct, 1.0, 1e-9);
}

// A heading that turns by 0.01 degree a metre beside a straight truth of 500 m.
KittiError of_constant_yaw_drift() {
  const double drift_rad = 0.01 * std::numbers::pi / 180.0;
  const std::vector<SE3> truth = straight_line(501, 1.0);
  std::vector<SE3> estimate{SE3::Identity()};
  while (estimate.size() < truth.size()) estimate.push_back(estimate.back() * pose(1.0, 0, 0, drift_rad));
  return kitti_error(truth, estimate);
}

// 1 degree per 100 m over every length.
TEST(KittiError, ConstantYawDrift) {
  const KittiError error = of_constant_yaw_drift();
  EXPECT_NEAR(error.r_rel_deg_100m().value(), 1.0, 1e-6);
  // Segment of 100 m: the ends of an arc of 1 degree and of its tangent lie about L * angle / 2 apart.
  EXPECT_NEAR(error.per_length()[0].t_rel_pct, 100.0 * std::numbers::pi / 180.0 / 2.0, 0.01);
}

TEST(KittiError, PureOffsetAndRigidMotionsAreNoError) {
  std::mt19937 random(1);
  const std::vector<SE3> truth = random_drive(random, 400, 1.2);
  const KittiError error = kitti_error(truth, moved(truth, se3_exp(random_twist(random, 1.0, 50.0))));
  EXPECT_NEAR(error.t_rel_pct().value(), 0.0, 1e-9);
  EXPECT_NEAR(error.r_rel_deg_100m().value(), 0.0, 1e-5);
}

TEST(KittiError, DoesNotDependOnTheFrameOfEitherTrajectory) {
  std::mt19937 random(2);
  for (int round = 0; round < 10; ++round) {
    const std::vector<SE3> truth = random_drive(random, 300, 1.0);
    const std::vector<SE3> estimate = with_drift(random, truth, 0.002, 0.01);
    const KittiError plain = kitti_error(truth, estimate);
    const KittiError displaced = kitti_error(moved(truth, se3_exp(random_twist(random, 1.0, 50.0))),
                                             moved(estimate, se3_exp(random_twist(random, 1.0, 50.0))));
    EXPECT_NEAR(plain.t_rel_pct().value(), displaced.t_rel_pct().value(), 1e-9);
    EXPECT_NEAR(plain.r_rel_deg_100m().value(), displaced.r_rel_deg_100m().value(), 1e-7);
  }
}

// 100 m in steps of 1 m: lengths 10, 20 … 80 m.
TEST(KittiError, ShortPathsFallBackToEighths) {
  const std::vector<SE3> truth = straight_line(101, 1.0);
  const KittiError error = kitti_error(truth, scaled(truth, 0.98));
  EXPECT_TRUE(error.short_path);
  const std::vector<KittiLengthError> rows = error.per_length();
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_DOUBLE_EQ(rows.front().length_m, 10.0);
  EXPECT_DOUBLE_EQ(rows.back().length_m, 80.0);
  EXPECT_EQ(rows.back().count, 3U);
  EXPECT_NEAR(error.t_rel_pct().value(), 2.0, 1e-9);
}

TEST(KittiError, FromExactly150MetresOnThePathIsLong) {
  const std::vector<SE3> truth = straight_line(151, 1.0);
  const KittiError error = kitti_error(truth, truth);
  EXPECT_FALSE(error.short_path);
  EXPECT_EQ(error.segments.size(), 6U);  // of 100 m, from 0, 10 … 50 m on
}

// A turn by 45 degrees as a text of three digits has it: not quite a rotation.
TEST(KittiError, EqualPosesOfFewDigitsAreNoError) {
  std::vector<SE3> poses = straight_line(121, 1.0);
  for (SE3& T : poses) T.linear() << 0.707, -0.707, 0, 0.707, 0.707, 0, 0, 0, 1;
  EXPECT_NEAR(kitti_error(poses, poses).t_rel_pct().value(), 0.0, 1e-9);
  EXPECT_NEAR(kitti_error(poses, poses).r_rel_deg_100m().value(), 0.0, 1e-4);
  EXPECT_TRUE(alignment_of(poses, poses, Alignment::kFirstPose).isApprox(SE3::Identity(), 1e-12));
}

TEST(KittiError, SegmentsEndAtTheFirstPoseFarEnough) {
  const std::vector<SE3> truth = straight_line(60, 3.0);  // poses at 0, 3, 6 … 177 m
  const KittiError error = kitti_error(truth, truth);
  ASSERT_FALSE(error.segments.empty());
  EXPECT_EQ(error.segments.front().first, 0U);
  EXPECT_EQ(error.segments.front().last, 34U);  // 102 m
  EXPECT_EQ(error.segments.size(), 3U);         // starts at 0, 30 and 60 m; 90 + 100 m is beyond the end
}

TEST(KittiError, OwnLengths) {
  const std::vector<SE3> truth = straight_line(101, 1.0);
  const KittiError error = kitti_error(truth, scaled(truth, 1.5), {20.0});
  EXPECT_FALSE(error.short_path);
  ASSERT_EQ(error.per_length().size(), 1U);
  EXPECT_EQ(error.per_length()[0].count, 9U);
  EXPECT_NEAR(error.t_rel_pct().value(), 50.0, 1e-9);
  EXPECT_THROW(kitti_error(truth, truth, {0.0}), std::invalid_argument);
  EXPECT_THROW(kitti_error(truth, truth, {-5.0}), std::invalid_argument);
  EXPECT_THROW(kitti_error(truth, truth, {std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
  EXPECT_THROW(kitti_error(truth, truth, {std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

TEST(KittiError, ASensorAtRestHasNoRelativeError) {
  const std::vector<SE3> truth(20, pose(1, 2, 3));
  const KittiError error = kitti_error(truth, straight_line(20, 1.0));
  EXPECT_FALSE(error.t_rel_pct().has_value());
  EXPECT_FALSE(error.r_rel_deg_100m().has_value());
  EXPECT_TRUE(error.per_length().empty());
  EXPECT_FALSE(kitti_benchmark({error}).pooled_t_rel_pct.has_value());
}

TEST(KittiError, RefusesBadTrajectories) {
  EXPECT_THROW(kitti_error(straight_line(5, 1.0), straight_line(4, 1.0)), std::invalid_argument);
  EXPECT_THROW(kitti_error({}, {}), std::invalid_argument);
}

// 91 + 81 + … segments with 1 % beside 11 with 3 %: the pooled mean leans on the longer drive, the other does not.
TEST(KittiBenchmark, PooledAndPerSequenceMeansDiffer) {
  const std::vector<SE3> long_drive = straight_line(1001, 1.0);
  const std::vector<SE3> short_drive = straight_line(201, 1.0);
  const KittiError a = kitti_error(long_drive, scaled(long_drive, 1.01));
  const KittiError b = kitti_error(short_drive, scaled(short_drive, 1.03));
  const KittiError at_rest = kitti_error(std::vector<SE3>(3, pose(0, 0, 0)), straight_line(3, 1.0));
  const auto na = static_cast<double>(a.segments.size());
  const auto nb = static_cast<double>(b.segments.size());
  EXPECT_EQ(b.segments.size(), 12U);  // 11 of 100 m, 1 of 200 m
  const KittiBenchmark benchmark = kitti_benchmark({a, at_rest, b});
  EXPECT_NEAR(benchmark.sequence_mean_t_rel_pct.value(), 2.0, 1e-9);
  EXPECT_NEAR(benchmark.pooled_t_rel_pct.value(), (na + 3.0 * nb) / (na + nb), 1e-9);
  EXPECT_NEAR(benchmark.pooled_r_rel_deg_100m.value(), 0.0, 1e-9);
  ASSERT_EQ(benchmark.per_length.size(), 8U);
  EXPECT_EQ(benchmark.per_length[0].count, 91U + 11U);
  EXPECT_NEAR(benchmark.per_length[0].t_rel_pct, (91.0 + 33.0) / 102.0, 1e-9);
  EXPECT_FALSE(kitti_benchmark({}).pooled_t_rel_pct.has_value());
}

// 41 + 31 + 21 + 11 + 1 = 105 segments with 1 degree per 100 m, 12 without an error.
TEST(KittiBenchmark, SoDoThoseOfRotations) {
  const std::vector<SE3> straight = straight_line(201, 1.0);
  const KittiBenchmark benchmark = kitti_benchmark({of_constant_yaw_drift(), kitti_error(straight, straight)});
  EXPECT_NEAR(benchmark.sequence_mean_r_rel_deg_100m.value(), 0.5, 1e-6);
  EXPECT_NEAR(benchmark.pooled_r_rel_deg_100m.value(), 105.0 / 117.0, 1e-6);
}

}  // namespace
}  // namespace rilo::test
