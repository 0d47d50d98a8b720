#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "view_history.hpp"

namespace rilo::view {
namespace {

/// A sweep of a round wall of 10 m, at x = i m.
ViewSweep sweep_at(std::size_t i, std::size_t points = 400) {
  ViewSweep sweep;
  sweep.index = i;
  sweep.result.status = OdometryStatus::kOk;
  sweep.result.T_odom_lidar.translation().x() = static_cast<double>(i);
  for (std::size_t k = 0; k < points; ++k) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(points);
    sweep.sweep.points.emplace_back(10.0F * std::cos(angle), 10.0F * std::sin(angle),
                                    0.1F * static_cast<float>(k % 20));
  }
  return sweep;
}

ViewOptions unhurried() {
  ViewOptions options;
  options.share = 1.0;
  return options;
}

TEST(ViewHistory, KeepsRecordsMapAndSweeps) {
  ViewHistory history(ViewInfo{}, unhurried());
  for (std::size_t i = 0; i < 50; ++i) history.add(sweep_at(i), true);
  history.finish();
  EXPECT_EQ(history.records(), 50U);
  EXPECT_EQ(history.records_from(48)->size(), 2 * kHeaderBytes + 2 * kRecordBytes);
  EXPECT_FALSE(history.map_frames().empty());
  EXPECT_EQ(history.sweeps().size(), 50U);
  EXPECT_TRUE(history.progress().finished);
  EXPECT_EQ(history.progress().dropped, 0U);
}

TEST(ViewHistory, LostSweepsAreShownButNotPutIntoTheMap) {
  ViewHistory history(ViewInfo{}, unhurried());
  ViewSweep lost = sweep_at(0);
  lost.result.status = OdometryStatus::kLost;
  history.add(lost, true);
  history.finish();
  EXPECT_TRUE(history.map_frames().empty());
  EXPECT_EQ(history.sweeps().size(), 1U);
}

TEST(ViewHistory, ACoarserMapBeginsAnew) {
  ViewOptions options = unhurried();
  options.map_points = 2000;
  ViewHistory history(ViewInfo{}, options);
  for (std::size_t i = 0; i < 200; ++i) history.add(sweep_at(i), false);
  history.finish();
  EXPECT_GT(history.map_epoch(), 0U);
  std::size_t points = 0;
  for (const Frame& frame : history.map_frames()) {
    std::uint32_t count = 0;
    std::memcpy(&count, frame->data() + 4, 4);
    points += count;
    EXPECT_EQ((*frame)[2], frame == history.map_frames().front() ? 1 : 0);  // the page forgets what it had
  }
  EXPECT_LE(points, options.map_points);
}

// The points of hours of sweeps fit into the memory that is set, and the whole run stays there.
TEST(ViewHistory, OldSweepsGetRarer) {
  SweepStore store(100'000);
  for (std::uint32_t i = 0; i < 5000; ++i) store.add(i, std::make_shared<const Bytes>(1000));
  EXPECT_LE(store.bytes(), 100'000U);
  EXPECT_GT(store.size(), 30U);
  EXPECT_EQ(store.newest_number(), 4999U);
  EXPECT_EQ(store.at(0), store.at(1));
  // Evenly: none of the run's tenths is without.
  for (std::uint32_t i = 0; i < 5000; i += 500) EXPECT_NE(store.at(i), store.at(i + 499)) << i;
  EXPECT_EQ(store.at(std::numeric_limits<std::uint32_t>::max()), store.newest());
  EXPECT_EQ(SweepStore(10).at(0), nullptr);
}

TEST(ViewHistory, AShareOfTimeIsNotExceeded) {
  ViewOptions options;
  options.share = 0.001;
  ViewHistory history(ViewInfo{}, options);
  for (std::size_t i = 0; i < 20; ++i) history.add(sweep_at(i, 20000), true);
  EXPECT_EQ(history.records(), 20U);  // poses and statistics are never lost
  EXPECT_EQ(history.progress().dropped, 20U - history.sweeps().size());
  EXPECT_GT(history.progress().dropped, 0U);
}

TEST(ViewHistory, DroppedPointsAreFilledInAfterwards) {
  ViewHistory history(ViewInfo{}, unhurried());
  for (std::size_t i = 0; i < 12; ++i) {
    const bool dropped = i % 3 != 0;
    history.add(sweep_at(i, dropped ? 0 : 400), true);
    if (dropped) history.note_dropped();
  }
  EXPECT_EQ(history.progress().dropped, 8U);
  EXPECT_EQ(history.sweeps().at(5), history.sweeps().at(3));
  const std::vector<std::uint32_t> missing = history.choose_missing();
  EXPECT_EQ(missing, (std::vector<std::uint32_t>{1, 2, 4, 5, 7, 8, 10, 11}));
  for (const std::uint32_t number : missing) history.fill(number, sweep_at(number), true);
  history.fill(3, sweep_at(3), true);  // has its points already
  EXPECT_EQ(history.progress().dropped, 0U);
  EXPECT_EQ(history.records(), 12U);
  EXPECT_EQ(history.sweeps().size(), 12U);
  EXPECT_NE(history.sweeps().at(5), history.sweeps().at(3));
  EXPECT_EQ(history.sweeps().newest_number(), 11U);
}

TEST(ViewHistory, OnlyAsManyAreFilledInAsThereIsRoomFor) {
  ViewOptions options = unhurried();
  options.sweep_bytes = 20'000;
  ViewHistory history(ViewInfo{}, options);
  history.add(sweep_at(0), true);
  for (std::size_t i = 1; i < 40; ++i) {
    history.add(sweep_at(i, 0), true);
    history.note_dropped();
  }
  const std::size_t frame_bytes = history.sweeps().bytes();
  const std::vector<std::uint32_t> missing = history.choose_missing();
  EXPECT_GT(missing.size(), 2U);
  EXPECT_LE(missing.size() * frame_bytes, options.sweep_bytes);
  EXPECT_GT(missing.back(), 30U);  // evenly over the run
  EXPECT_EQ(history.progress().dropped, missing.size());
}

TEST(SweepPoints, AreCompensatedChosenAndMeasured) {
  ViewSweep sweep;
  sweep.result.twist[3] = 10.0;  // m/s forward
  sweep.sweep.points = {{20, 0, 0}, {20, 1, 0}, {20, 2, 0}, {0.1F, 0, 0}, {500, 0, 0}};
  sweep.sweep.times_s = {0.0F, 0.05F, 0.1F, 0.05F, 0.05F};
  const SweepPoints points = sample_sweep(sweep, 100, 1.0, 100.0, 0);
  ASSERT_EQ(points.points.size(), 3U);  // too near and too far are left out
  EXPECT_NEAR(points.points[0].x(), 19.5F, 1e-3F);
  EXPECT_NEAR(points.points[1].x(), 20.0F, 1e-3F);
  EXPECT_NEAR(points.points[2].x(), 20.5F, 1e-3F);

  SweepPoints wall;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k)
      wall.points.emplace_back(10.3F, 0.2F * static_cast<float>(i), 0.2F * static_cast<float>(k));
  }
  ResidualMap map;
  map.measure(SE3::Identity(), wall);
  EXPECT_TRUE(std::isnan(wall.residuals_m[800]));
  map.add(SE3::Identity(), wall);
  SE3 off = SE3::Identity();
  off.translation().x() = 0.07;
  map.measure(off, wall);
  EXPECT_NEAR(wall.residuals_m[820], 0.07F, 1e-3F);
}

TEST(ViewHistory, TheIntroductionIsJsonWhateverTheNameOfTheData) {
  ViewInfo info;
  info.title = "a\"b\\\xFF</script>";
  ViewHistory history(info, ViewOptions{});
  const Frame frame = history.info();
  const auto json = nlohmann::json::parse(frame->begin() + kHeaderBytes, frame->end());
  EXPECT_EQ(json["status"].size(), kStatusCount);
  EXPECT_EQ(json["initial_pose_reason"][7], "no_time");
}

}  // namespace
}  // namespace rilo::view
