#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "evaluation/trajectories.hpp"
#include "rilo/evaluation/evaluation.hpp"

namespace rilo::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(AbsolutePoseError, PureOffset) {
  const std::vector<SE3> truth = straight_line(50, 1.0);
  const std::vector<SE3> estimate = moved(truth, pose(0, 3, 4));
  const AbsolutePoseError as_given = absolute_pose_error(truth, estimate, Alignment::kNone);
  EXPECT_NEAR(as_given.translation_m.rmse, 5.0, 1e-12);
  EXPECT_NEAR(as_given.translation_m.std, 0.0, 1e-12);
  EXPECT_NEAR(as_given.translation_m.max, 5.0, 1e-12);
  EXPECT_NEAR(as_given.rotation_deg.max, 0.0, 1e-9);
  EXPECT_NEAR(absolute_pose_error(truth, estimate, Alignment::kFirstPose).translation_m.max, 0.0, 1e-12);
  EXPECT_NEAR(absolute_pose_error(truth, estimate, Alignment::kUmeyama).translation_m.max, 0.0, 1e-9);
}

// Truth at 0 … 100 m, estimate 1 % longer. First poses equal: errors 0 … 1 m, mean 0.5 m. Aligned: centred, −0.5 … 0.5
// m.
TEST(AbsolutePoseError, OnePercentOfScale) {
  const std::vector<SE3> truth = straight_line(101, 1.0);
  const std::vector<SE3> estimate = straight_line(101, 1.01);
  const AbsolutePoseError first = absolute_pose_error(truth, estimate, Alignment::kFirstPose);
  EXPECT_NEAR(first.translation_m.mean, 0.5, 1e-9);
  EXPECT_NEAR(first.translation_m.max, 1.0, 1e-9);
  EXPECT_NEAR(first.translation_m.median, 0.5, 1e-9);
  const AbsolutePoseError aligned = absolute_pose_error(truth, estimate, Alignment::kUmeyama);
  EXPECT_NEAR(aligned.translation_m.max, 0.5, 1e-9);
  EXPECT_NEAR(aligned.translation_m.rmse, 0.01 * std::sqrt((101.0 * 101.0 - 1.0) / 12.0), 1e-9);
  EXPECT_NEAR(aligned.rotation_deg.max, 0.0, 1e-6);
}

TEST(AbsolutePoseError, RotationOfTheSensorAlone) {
  const std::vector<SE3> truth = straight_line(20, 1.0);
  std::vector<SE3> estimate = truth;
  for (SE3& T : estimate) T = T * pose(0, 0, 0, 2.0 * kDegree);
  const AbsolutePoseError error = absolute_pose_error(truth, estimate, Alignment::kNone);
  EXPECT_NEAR(error.rotation_deg.rmse, 2.0, 1e-9);
  EXPECT_NEAR(error.translation_m.max, 0.0, 1e-12);
}

TEST(AbsolutePoseError, InvariantToARigidMotionOfTheEstimate) {
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round) {
    const std::vector<SE3> truth = random_drive(random, 200, 1.0);
    const std::vector<SE3> estimate = with_drift(random, truth, 0.003, 0.02);
    const std::vector<SE3> displaced = moved(estimate, se3_exp(random_twist(random, 1.0, 100.0)));
    for (const Alignment alignment : {Alignment::kUmeyama, Alignment::kFirstPose}) {
      const AbsolutePoseError a = absolute_pose_error(truth, estimate, alignment);
      const AbsolutePoseError b = absolute_pose_error(truth, displaced, alignment);
      EXPECT_NEAR(a.translation_m.rmse, b.translation_m.rmse, 1e-9);
      EXPECT_NEAR(a.translation_m.median, b.translation_m.median, 1e-9);
      EXPECT_NEAR(a.rotation_deg.rmse, b.rotation_deg.rmse, 1e-7);
    }
    const ErrorSummary s = absolute_pose_error(truth, estimate, Alignment::kUmeyama).translation_m;
    EXPECT_NEAR(s.rmse * s.rmse, s.mean * s.mean + s.std * s.std, 1e-9);
    EXPECT_LE(s.rmse, absolute_pose_error(truth, estimate, Alignment::kFirstPose).translation_m.rmse + 1e-9);
  }
}

TEST(RelativePoseError, PerFrame) {
  const std::vector<SE3> truth = straight_line(11, 2.0);
  std::vector<SE3> estimate{SE3::Identity()};
  while (estimate.size() < truth.size()) estimate.push_back(estimate.back() * pose(2.1, 0, 0, 0.5 * kDegree));
  const RelativePoseError error = rpe_per_frame(truth, estimate);
  EXPECT_EQ(error.translation_m.count, 10U);
  EXPECT_NEAR(error.translation_m.mean, 0.1, 1e-9);
  EXPECT_NEAR(error.translation_m.max, 0.1, 1e-9);
  EXPECT_NEAR(error.rotation_deg.rmse, 0.5, 1e-9);
  EXPECT_NEAR(rpe_per_metre(truth, estimate).rotation_deg.rmse, 0.25, 1e-9);
}

// The same 5 % per metre whether poses lie 0.25 m, 1 m or 3 m apart.
TEST(RelativePoseError, PerMetreDoesNotDependOnTheFrameRate) {
  for (const auto& [step, pairs] : {std::pair(0.25, 56U), {1.0, 59U}, {3.0, 59U}}) {
    const RelativePoseError error = rpe_per_metre(straight_line(60, step), straight_line(60, 1.05 * step));
    EXPECT_NEAR(error.translation_m.median, 0.05, 1e-9) << step;
    EXPECT_NEAR(error.translation_m.max, 0.05, 1e-9) << step;
    EXPECT_EQ(error.translation_m.count, pairs);
  }
  EXPECT_EQ(rpe_per_metre(straight_line(5, 0.1), straight_line(5, 0.1)).translation_m.count, 0U);
}

TEST(ErrorSeries, AxesAreThoseOfTheTruePose) {
  // The truth turns left by 90 degrees after 10 m; the estimate then runs 0.2 m ahead and 0.1 m above.
  const std::vector<SE3> truth{pose(0, 0, 0), pose(10, 0, 0, 90.0 * kDegree), pose(10, 5, 0, 90.0 * kDegree)};
  std::vector<SE3> estimate = truth;
  estimate[2].translation() += Eigen::Vector3d(0, 0.2, 0.1);
  const std::vector<ErrorSample> series = error_series(truth, estimate, Alignment::kFirstPose);
  ASSERT_EQ(series.size(), 3U);
  EXPECT_NEAR(series[2].distance_m, 15.0, 1e-12);
  EXPECT_NEAR(series[2].axis_m.x(), 0.2, 1e-12);
  EXPECT_NEAR(series[2].axis_m.y(), 0.0, 1e-12);
  EXPECT_NEAR(series[2].axis_m.z(), 0.1, 1e-12);
  EXPECT_NEAR(series[2].translation_m, std::hypot(0.2, 0.1), 1e-12);
  EXPECT_NEAR(series[1].translation_m, 0.0, 1e-12);
}

TEST(Evaluate, GathersEverything) {
  const std::vector<SE3> truth = straight_line(301, 1.0);
  const std::vector<SE3> estimate = moved(straight_line(301, 1.01), pose(5, 5, 5, 1.0));
  const Evaluation e = evaluate(truth, estimate);
  EXPECT_EQ(e.poses, 301U);
  EXPECT_NEAR(e.path_m, 300.0, 1e-9);
  EXPECT_NEAR(e.kitti.t_rel_pct().value(), 1.0, 1e-9);
  EXPECT_NEAR(e.end_error_m, 3.0, 1e-9);
  EXPECT_NEAR(e.end_error_pct, 1.0, 1e-9);
  EXPECT_NEAR(e.ape_unaligned.translation_m.max, 3.0, 1e-9);
  EXPECT_NEAR(e.ape.translation_m.max, 1.5, 1e-9);
  EXPECT_NEAR(e.rpe_metre.translation_m.median, 0.01, 1e-9);
  EXPECT_NEAR(e.rpe_frame.translation_m.median, 0.01, 1e-9);
  EXPECT_EQ(e.series.size(), 301U);
  EXPECT_THROW(evaluate(truth, {}), std::invalid_argument);
}

TEST(Evaluate, ASensorAtRestGivesFiniteFigures) {
  const std::vector<SE3> rest(10, pose(1, 2, 3, 0.3));
  const Evaluation e = evaluate(rest, rest);
  EXPECT_EQ(e.path_m, 0.0);
  EXPECT_EQ(e.end_error_pct, 0.0);
  EXPECT_NEAR(e.ape.translation_m.max, 0.0, 1e-12);
  EXPECT_NEAR(e.ape.rotation_deg.max, 0.0, 1e-6);
  EXPECT_EQ(e.rpe_metre.translation_m.count, 0U);
}

}  // namespace
}  // namespace rilo::test
