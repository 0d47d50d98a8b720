#include "rilo/simulation/drive_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "simulation/drive_path.hpp"

namespace rilo {
namespace {

DriveConfig small_drive() {
  DriveConfig config;
  config.sensor = SensorKind::kVlp16;
  config.sweeps = 3;
  config.start_s = 7;  // driving, near a bend
  config.threads = 1;
  return config;
}

bool same_bits(const Sweep& a, const Sweep& b) {
  return a.stamp_ns == b.stamp_ns && a.points == b.points && a.times_s == b.times_s && a.intensities == b.intensities &&
         a.rings == b.rings;
}

TEST(DriveSimulator, SameBytesForAnyNumberOfThreadsAndInAnyOrder) {
  DriveConfig config = small_drive();
  const DriveSimulator one(config);
  const SimulatedSweep last = one.sweep(2);
  const SimulatedSweep first = one.sweep(0);
  for (const int threads : {2, 4}) {
    config.threads = threads;
    const DriveSimulator many(config);
    EXPECT_TRUE(same_bits(many.sweep(0).sweep, first.sweep)) << threads;
    EXPECT_TRUE(same_bits(many.sweep(2).sweep, last.sweep)) << threads;
    EXPECT_EQ(many.sweep(2).T_odom_lidar_end.matrix(), last.T_odom_lidar_end.matrix());
  }
}

TEST(DriveSimulator, AnotherSeedIsAnotherTown) {
  DriveConfig config = small_drive();
  const Sweep a = DriveSimulator(config).sweep(0).sweep;
  config.seed = 2;
  EXPECT_FALSE(same_bits(a, DriveSimulator(config).sweep(0).sweep));
}

TEST(DriveSimulator, ColumnsAreFullAndInOrder) {
  for (const SensorKind kind : {SensorKind::kHdl64, SensorKind::kVlp16, SensorKind::kOs1}) {
    DriveConfig config = small_drive();
    config.sensor = kind;
    const DriveSimulator drive(config);
    const SensorModel& sensor = drive.sensor();
    const Sweep s = drive.sweep(1).sweep;
    ASSERT_EQ(s.times_s.size(), s.points.size());
    ASSERT_EQ(s.rings.size(), s.points.size());
    ASSERT_EQ(s.intensities.size(), s.points.size());
    EXPECT_EQ(s.stamp_ns, 100'000'000);
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      const Eigen::Vector3d p = s.points[i].cast<double>();
      const double fraction = static_cast<double>(s.times_s[i]) / sensor.period_s;
      ASSERT_GE(fraction, 0);
      ASSERT_LT(fraction, 1);
      ASSERT_TRUE(i == 0 || s.times_s[i] > s.times_s[i - 1] ||
                  (s.times_s[i] == s.times_s[i - 1] && s.rings[i] > s.rings[i - 1]));
      // What is reported is the beam's direction, exactly.
      const double turn = std::remainder(std::atan2(p.y(), p.x()) - SensorModel::azimuth_rad(fraction), 2 * M_PI);
      ASSERT_NEAR(turn, 0, 1e-5);
      ASSERT_NEAR(std::asin(p.z() / p.norm()), sensor.elevations_rad[s.rings[i]], 1e-5);
      ASSERT_GE(p.norm(), sensor.min_range_m - 1e-4);
      ASSERT_LE(p.norm(), sensor.max_range_m + 0.2);
      ASSERT_GE(s.intensities[i], 0);
      ASSERT_LE(s.intensities[i], 1);
    }
  }
}

TEST(DriveSimulator, MostBeamsAnswerInATown) {
  const std::map<SensorKind, std::pair<std::size_t, std::size_t>> plausible = {{SensorKind::kHdl64, {100'000, 133'000}},
                                                                               {SensorKind::kVlp16, {20'000, 28'800}},
                                                                               {SensorKind::kOs1, {45'000, 65'000}}};
  for (const auto& [kind, band] : plausible) {
    DriveConfig config = small_drive();
    config.sensor = kind;
    const std::size_t points = DriveSimulator(config).sweep(0).sweep.points.size();
    EXPECT_GE(points, band.first) << to_string(kind);
    EXPECT_LE(points, band.second) << to_string(kind);
  }
}

TEST(DriveSimulator, PosesAreRelativeToTheFirstSweepsSameInstant) {
  const DriveSimulator drive(small_drive());
  const SimulatedSweep first = drive.sweep(0);
  for (const SE3& T : {first.T_odom_lidar_start, first.T_odom_lidar_mid, first.T_odom_lidar_end}) {
    EXPECT_EQ(T.matrix(), Eigen::Matrix4d::Identity());
  }
  const SimulatedSweep last = drive.sweep(2);
  EXPECT_TRUE(last.T_odom_lidar_start.isApprox(drive.pose_at(0).inverse() * drive.pose_at(0.2), 1e-12));
  EXPECT_TRUE(last.T_odom_lidar_mid.isApprox(drive.pose_at(0.05).inverse() * drive.pose_at(0.25), 1e-12));
  EXPECT_TRUE(last.T_odom_lidar_end.isApprox(drive.pose_at(0.1).inverse() * drive.pose_at(0.3), 1e-12));
  EXPECT_GT(last.T_odom_lidar_mid.translation().x(), 0.3);  // drives forward
}

TEST(DriveSimulator, DeskewedPointsAreTheRawOnesThroughTheExactMotion) {
  DriveConfig config = small_drive();
  const DriveSimulator raw_drive(config);
  config.deskewed = true;
  const DriveSimulator deskewed_drive(config);
  const Sweep raw = raw_drive.sweep(2).sweep;
  const Sweep deskewed = deskewed_drive.sweep(2).sweep;
  ASSERT_EQ(raw.points.size(), deskewed.points.size());
  EXPECT_TRUE(deskewed.times_s.empty());
  EXPECT_EQ(raw.rings, deskewed.rings);
  const SE3 T_mid_world = raw_drive.pose_at(0.25).inverse();
  double largest_shift = 0;
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const SE3 T_world_sensor = raw_drive.pose_at(0.2 + static_cast<double>(raw.times_s[i]));
    const Eigen::Vector3d expected = T_mid_world * T_world_sensor * raw.points[i].cast<double>();
    ASSERT_LT((expected - deskewed.points[i].cast<double>()).norm(), 2e-5) << i;
    largest_shift = std::max(largest_shift, static_cast<double>((raw.points[i] - deskewed.points[i]).norm()));
  }
  EXPECT_GT(largest_shift, 0.2);  // the sweep was distorted indeed
}

TEST(DriveSimulator, DropoutLosesItsShare) {
  DriveConfig config = small_drive();
  config.dropout = 0;
  const auto all = static_cast<double>(DriveSimulator(config).sweep(0).sweep.points.size());
  config.dropout = 0.3;
  const auto kept = static_cast<double>(DriveSimulator(config).sweep(0).sweep.points.size());
  EXPECT_NEAR(kept / all, 0.7, 0.015);
}

// Ranges by (time, ring) of one sweep.
std::map<std::pair<float, int>, double> ranges(const DriveConfig& config) {
  std::map<std::pair<float, int>, double> result;
  const Sweep s = DriveSimulator(config).sweep(0).sweep;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    result[{s.times_s[i], s.rings[i]}] = static_cast<double>(s.points[i].norm());
  }
  return result;
}

TEST(DriveSimulator, NoiseHasItsDeviation) {
  DriveConfig config = small_drive();
  config.noise_m = 0;
  const auto exact = ranges(config);
  config.noise_m = 0.05;
  const auto noisy = ranges(config);
  double sum = 0;
  double square = 0;
  double count = 0;
  for (const auto& [beam, range] : exact) {
    const auto found = noisy.find(beam);
    if (found == noisy.end()) continue;
    const double error = found->second - range;
    sum += error;
    square += error * error;
    ++count;
  }
  ASSERT_GT(count, 15'000);
  EXPECT_NEAR(sum / count, 0, 0.0015);
  EXPECT_NEAR(std::sqrt(square / count), 0.05, 0.001);
}

TEST(DriveSimulator, ABiasedBeamSeesWhatTheOneAboveShouldSee) {
  DriveConfig config = small_drive();
  config.noise_m = 0;
  const auto straight = ranges(config);
  config.elevation_bias_deg = 2;  // the distance between two beams
  std::size_t compared = 0;
  for (const auto& [beam, range] : ranges(config)) {
    const auto above = straight.find({beam.first, beam.second - 1});
    if (above == straight.end()) continue;
    ++compared;
    ASSERT_NEAR(range, above->second, 1e-4);
  }
  EXPECT_GT(compared, 15'000U);
}

TEST(DriveSimulator, TheGroundLiesBelowTheSensor) {
  DriveConfig config = small_drive();
  config.start_s = 0;
  config.moving_cars = 0;
  config.parked_cars = 0;
  const Sweep s = DriveSimulator(config).sweep(0).sweep;
  // The steepest beams meet the road within a few metres: mount height below, but for slope and camber.
  std::size_t near_road = 0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Eigen::Vector3f& p = s.points[i];
    if (s.rings[i] != 15 || std::abs(p.y()) > 2) continue;
    ++near_road;
    EXPECT_NEAR(p.z(), -1.73F, 0.35F);
  }
  EXPECT_GT(near_road, 100U);
  EXPECT_TRUE(std::none_of(s.points.begin(), s.points.end(), [](const auto& p) { return p.z() < -8; }));
}

TEST(DriveSimulator, ByDefaultALapAndAnOverlap) {
  DriveConfig config;
  const DriveSimulator drive(config);
  EXPECT_GT(drive.size(), 200U);
  EXPECT_EQ(drive.config().sweeps, drive.size());
  const double end_s = 0.1 * static_cast<double>(drive.size());
  EXPECT_GT(end_s, drive.path().lap_s());
  EXPECT_NEAR(drive.path().distance_m(end_s), drive.path().lap_m() + 50, 1.1);
  config.speed_mps = 2;  // the slowest drive gets round too
  const DriveSimulator slow(config);
  EXPECT_NEAR(slow.path().distance_m(0.1 * static_cast<double>(slow.size())), slow.path().lap_m() + 50, 0.3);
}

TEST(DriveSimulator, RefusesWhatItCannotDo) {
  DriveConfig config = small_drive();
  EXPECT_THROW(DriveSimulator(config).sweep(3), std::out_of_range);
  config.dropout = 2;
  EXPECT_THROW(DriveSimulator{config}, std::invalid_argument);
}

TEST(DriveSimulator, EmptyStreetsAndFullOnes) {
  DriveConfig config = small_drive();
  config.moving_cars = 0;
  config.parked_cars = 0;
  config.trees = 0;
  const Sweep empty = DriveSimulator(config).sweep(0).sweep;
  config.moving_cars = 12;
  config.parked_cars = 1;
  config.trees = 1;
  const Sweep full = DriveSimulator(config).sweep(0).sweep;
  // Cars at the kerb hide ground and walls: more is near.
  const auto near = [](const Sweep& s) {
    return std::count_if(s.points.begin(), s.points.end(), [](const auto& p) { return p.norm() < 5; });
  };
  EXPECT_GT(near(full), near(empty));
}

}  // namespace
}  // namespace rilo
