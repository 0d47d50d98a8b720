// A simulated drive whose recording has lost, repeated, late and wrongly stamped sweeps: the odometry goes on.
#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::test {
namespace {

constexpr std::size_t kSweeps = 14;

std::vector<SimulatedSweep> simulated() {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = kSweeps;
  config.start_s = 20;
  const DriveSimulator drive(config);
  std::vector<SimulatedSweep> sweeps;
  for (std::size_t i = 0; i < kSweeps; ++i) {
    sweeps.push_back(drive.sweep(i));
    sweeps.back().sweep.stamp_ns += 1'700'000'000'000'000'000;
  }
  return sweeps;
}

struct Driven {
  std::vector<SE3> poses;
  StampFaults faults;
};

Driven run_recording(const std::vector<Sweep>& sweeps) {
  const TempDir folder;
  const auto source = open_scan_source(folder.write(
      "d.mcap", mcap_bytes({{"/points", kRos2Type}}, recorded(sweeps, MessageEncoding::kCdr), {"lz4", 3})));
  Odometry odometry({});
  Driven run;
  while (const auto sweep = source->next()) run.poses.push_back(odometry.register_sweep(*sweep).T_odom_lidar);
  run.faults = source->info().faults;
  return run;
}

double error_m(const SE3& pose, const SimulatedSweep& truth) {
  return (pose.translation() - truth.T_odom_lidar_mid.translation()).norm();
}

TEST(FaultyDriveTest, WhatIsLeftOutDoesNotShow) {
  const auto drive = simulated();
  std::vector<Sweep> recorded;
  for (const std::size_t i : std::vector<std::size_t>{0, 1, 1, 2, 3, 5, 4, 6, 7, 7, 7, 10, 11, 12, 11, 13}) {
    recorded.push_back(drive[i].sweep);
  }
  const Driven run = run_recording(recorded);
  const std::vector<std::size_t> used{0, 1, 2, 3, 5, 6, 7, 10, 11, 12, 13};
  ASSERT_EQ(run.poses.size(), used.size());
  Odometry odometry({});
  for (std::size_t k = 0; k < used.size(); ++k) {
    EXPECT_EQ(run.poses[k].matrix(), odometry.register_sweep(drive[used[k]].sweep).T_odom_lidar.matrix()) << used[k];
    EXPECT_LT(error_m(run.poses[k], drive[used[k]]), 0.2) << used[k];
  }
  EXPECT_GT(run.poses.back().translation().norm(), 3.0);
  EXPECT_EQ(run.faults.duplicates, 3U);
  EXPECT_EQ(run.faults.out_of_order, 2U);
  EXPECT_EQ(run.faults.gaps, 2U);
  EXPECT_EQ(run.faults.missing, 3U);
}

TEST(FaultyDriveTest, AClockThatIsSetBackDoesNotLoseTheWay) {
  const auto drive = simulated();
  std::vector<Sweep> recorded;
  for (std::size_t i = 0; i < kSweeps; ++i) {
    recorded.push_back(drive[i].sweep);
    if (i >= 7) recorded.back().stamp_ns -= 3'600'000'000'000;
  }
  const Driven run = run_recording(recorded);
  ASSERT_EQ(run.poses.size(), kSweeps);
  EXPECT_EQ(run.faults.clock_jumps, 1U);
  for (std::size_t i = 0; i < kSweeps; ++i) EXPECT_LT(error_m(run.poses[i], drive[i]), 0.2) << i;
}

}  // namespace
}  // namespace rilo::test
