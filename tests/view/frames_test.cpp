#include "frames.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

namespace rilo::view {
namespace {

template <typename Number>
Number at(const Bytes& bytes, std::size_t offset) {
  Number value{};
  EXPECT_LE(offset + sizeof(Number), bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof(Number));
  return value;
}

ViewSweep sweep_7() {
  ViewSweep sweep;
  sweep.index = 7;
  sweep.result.stamp_ns = 1'234'567'890'123'456'789;
  sweep.result.T_odom_lidar.translation() = Eigen::Vector3d(1.5, -2.5, 1e4);
  sweep.result.status = OdometryStatus::kDegenerate;
  sweep.result.stats.initial_pose = InitialPoseSource::kCoarse;
  sweep.result.stats.initial_pose_reason = InitialPoseReason::kBetterMapScore;
  sweep.result.stats.coarse_ran = true;
  sweep.result.stats.sigma_th_m = 0.25;
  sweep.result.stats.inliers = 1234;
  sweep.result.stats.iterations = 70000;  // more than the field holds
  sweep.result.stats.times.total_ms = 12.5;
  sweep.result.stats.relative_eigenvalues[5] = 1.0;
  sweep.result.covariance(4, 4) = 9.0;
  sweep.result.translation_evidence(0, 2) = 0.5;
  sweep.result.stats.map_voxels = 4711;
  sweep.truth = Eigen::Vector3d(1, 2, 3);
  return sweep;
}

// The numbers are those of src/view/frames.md, written down once more.
TEST(Frames, ARecordLiesAsDocumented) {
  Bytes records;
  append_record(sweep_7(), records);
  ASSERT_EQ(records.size(), kRecordBytes);
  const Frame frame = records_frame(5, records);
  EXPECT_EQ(at<std::uint32_t>(*frame, 0), 0x0000'0102U);  // type 2, version 1, no flags
  EXPECT_EQ(at<std::uint32_t>(*frame, 4), 1U);
  EXPECT_EQ(at<std::uint32_t>(*frame, 8), 5U);
  EXPECT_EQ(at<std::uint32_t>(records, 0), 7U);
  EXPECT_EQ(records[4], static_cast<std::uint8_t>(OdometryStatus::kDegenerate));
  EXPECT_EQ(records[5], static_cast<std::uint8_t>(InitialPoseSource::kCoarse));
  EXPECT_EQ(records[7], 1U | 4U | 8U);
  EXPECT_EQ(at<std::int64_t>(records, 8), 1'234'567'890'123'456'789);
  EXPECT_EQ(at<double>(records, 24), -2.5);
  EXPECT_EQ(at<float>(records, 52), 1.0F);  // w of the quaternion
  EXPECT_EQ(at<float>(records, 64), 3.0F);  // z of the truth
  EXPECT_EQ(at<float>(records, 68), 0.25F);
  EXPECT_EQ(at<std::uint32_t>(records, 76), 1234U);
  EXPECT_EQ(at<std::uint16_t>(records, 80), 65535U);
  EXPECT_EQ(at<float>(records, 88), 12.5F);
  EXPECT_EQ(at<float>(records, 144), 1.0F);  // the largest eigenvalue
  EXPECT_EQ(at<float>(records, 160), 9.0F);  // yy of the covariance
  EXPECT_EQ(at<float>(records, 180), 0.5F);  // xz of the evidence
  EXPECT_EQ(at<std::uint32_t>(records, 212), 4711U);
}

TEST(Frames, MapPointsComeBackToTheirPlace) {
  std::vector<MapPoint> points;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto s = static_cast<float>(i);
    points.push_back({{9000.0F + 0.1F * s, std::sin(s), 3.0F}, 500 + i / 10});
  }
  const Frame frame = map_frame(points, 0.28, true);
  ASSERT_EQ(frame->size(), 48 + 8 * points.size());
  EXPECT_EQ(at<std::uint32_t>(*frame, 0), 0x0001'0103U);
  EXPECT_EQ(at<std::uint32_t>(*frame, 40), 500U);
  const double scale = static_cast<double>(at<float>(*frame, 32));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = at<double>(*frame, 8 + 8 * axis) + scale * at<std::int16_t>(*frame, 48 + 8 * i + 2 * axis);
      ASSERT_NEAR(value, static_cast<double>(points[i].p[static_cast<Eigen::Index>(axis)]), 2e-3);
    }
    ASSERT_EQ(500U + at<std::uint16_t>(*frame, 48 + 8 * i + 6), points[i].sweep);
  }
  EXPECT_EQ(map_frame({}, 0.2, false)->size(), 48U);
}

TEST(Frames, ASweepHasTheColumnsThatItHas) {
  SweepPoints sweep;
  sweep.points = {{1, 2, 3}, {-50, 0, 1}, {4, 5, 6}};
  sweep.residuals_m = {0.0F, std::numeric_limits<float>::quiet_NaN(), 10.0F};
  const Frame frame = sweep_frame(9, sweep);
  ASSERT_EQ(frame->size(), 40U + 7 * 3);
  EXPECT_EQ(at<std::uint16_t>(*frame, 2), 2U);
  EXPECT_EQ(at<std::uint32_t>(*frame, 8), 9U);
  EXPECT_NEAR(at<float>(*frame, 12) * static_cast<float>(at<std::int16_t>(*frame, 46)), -50.0F, 1e-3F);
  const std::size_t residuals = 40 + 18;
  EXPECT_EQ((*frame)[residuals], 1U);
  EXPECT_EQ((*frame)[residuals + 1], 0U);  // no plane there
  EXPECT_EQ((*frame)[residuals + 2], 255U);

  sweep.intensities = {0.0F, 1.0F, std::numeric_limits<float>::infinity()};
  sweep.times_s = {-0.05F, 0.0F, 0.05F};
  const Frame full = sweep_frame(9, sweep);
  ASSERT_EQ(full->size(), 40U + 9 * 3);
  EXPECT_EQ(at<std::uint16_t>(*full, 2), 7U);
  EXPECT_FLOAT_EQ(at<float>(*full, 28), -0.05F);
  EXPECT_EQ((*full)[40 + 18 + 6 + 2], 255U);
}

TEST(Frames, RequestsAreTakenLiterally) {
  const Bytes sweep = {1, 1, 0, 0, 0x10, 0x27, 0, 0};
  ASSERT_TRUE(parse_request(sweep));
  EXPECT_EQ(parse_request(sweep)->value, 10000U);
  const std::vector<Bytes> hostile = {{},
                                      {1},
                                      {1, 1, 0, 0, 0, 0, 0},
                                      {1, 1, 0, 0, 0, 0, 0, 0, 0},
                                      {3, 1, 0, 0, 0, 0, 0, 0},
                                      {1, 2, 0, 0, 0, 0, 0, 0},
                                      {1, 1, 1, 0, 0, 0, 0, 0},
                                      {2, 1, 0, 0, 2, 0, 0, 0},
                                      Bytes(8, 0xFF)};
  for (const Bytes& message : hostile) EXPECT_FALSE(parse_request(message));
}

}  // namespace
}  // namespace rilo::view
