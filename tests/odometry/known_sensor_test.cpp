// What is known about the sensor goes from one run into the next.
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "cloud/beam_angles.hpp"
#include "geometry/degrees.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo {
namespace {

/// A sensor whose beams are off by 0.1 degrees.
BeamAngles poor_unit() {
  std::mt19937 rng(11);
  std::normal_distribution<float> error(0.0F, static_cast<float>(0.1 * kRadPerDeg));
  BeamAngles wrong;
  for (Beam beam = 0; beam < 64; ++beam) wrong.at(beam) = {error(rng), error(rng)};
  return wrong;
}

std::vector<Sweep> drive(double start_s, std::size_t sweeps, SensorKind sensor = SensorKind::kOs1) {
  DriveConfig config;
  config.start_s = start_s;
  config.sweeps = sweeps;
  config.sensor = sensor;
  const DriveSimulator simulator(config);
  const BeamAngles wrong = poor_unit();
  std::vector<Sweep> all;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    Sweep sweep = simulator.sweep(i).sweep;
    for (std::size_t k = 0; k < sweep.rings.size(); ++k) {
      sweep.points[k] = wrong.corrected(sweep.points[k], sweep.rings[k]);
    }
    all.push_back(std::move(sweep));
  }
  return all;
}

OdometryConfig quick() {
  OdometryConfig config;
  config.beams.gain = 0.2;
  return config;
}

SE3 last_pose(Odometry& odometry, const std::vector<Sweep>& sweeps) {
  SE3 pose;
  for (const Sweep& sweep : sweeps) pose = odometry.register_sweep(sweep).T_odom_lidar;
  return pose;
}

/// What a run with `sweeps` has learnt.
SensorAngles learnt_from(const std::vector<Sweep>& sweeps) {
  Odometry odometry(quick());
  last_pose(odometry, sweeps);
  return odometry.sensor_angles();
}

TEST(KnownSensor, AnotherRunBeginsWithWhatWasLearnt) {
  const SensorAngles learnt = learnt_from(drive(6.0, 15));
  ASSERT_EQ(learnt.beams.size(), 64U);
  double largest = 0;
  for (const BeamCorrection& beam : learnt.beams) largest = std::max(largest, std::abs(beam.add_elevation_rad));
  EXPECT_GT(largest, 0.02 * kRadPerDeg);

  const std::vector<Sweep> sweeps = drive(20.0, 3);
  Odometry unknown(quick());
  Odometry known(quick());
  known.start_with(learnt);
  double without_m = 0;
  double with_m = 0;
  for (const Sweep& sweep : sweeps) {
    without_m += unknown.register_sweep(sweep).stats.residual_rms_m;
    with_m += known.register_sweep(sweep).stats.residual_rms_m;
  }
  EXPECT_LT(with_m, 0.95 * without_m);
}

TEST(KnownSensor, StartingOverIsStartingWithWhatWasLearnt) {
  const std::vector<Sweep> sweeps = drive(6.0, 6);
  Odometry first(quick());
  last_pose(first, sweeps);
  Odometry second(quick());
  second.start_with(first.sensor_angles());
  first.start_over();
  EXPECT_EQ(last_pose(first, sweeps).matrix(), last_pose(second, sweeps).matrix());
}

TEST(KnownSensor, AResetGoesBackToWhatWasGiven) {
  const std::vector<Sweep> sweeps = drive(6.0, 6);
  SensorAngles known = learnt_from(sweeps);
  known.elevation_offset_rad = 0.2 * kRadPerDeg;
  Odometry odometry(quick());
  odometry.start_with(known);
  EXPECT_NEAR(odometry.sensor_angles().elevation_offset_rad, 0.2 * kRadPerDeg, 1e-12);
  const SE3 once = last_pose(odometry, sweeps);
  odometry.reset();
  EXPECT_EQ(odometry.trajectory().size(), 0U);
  EXPECT_EQ(last_pose(odometry, sweeps).matrix(), once.matrix());
  Odometry without(quick());
  EXPECT_NE(last_pose(without, sweeps).matrix(), once.matrix());
}

TEST(KnownSensor, AnotherSensorIsAnErrorAndNothingIsRegistered) {
  Odometry odometry(quick());
  const SensorAngles learnt = learnt_from(drive(6.0, 5));
  odometry.start_with(learnt);
  const std::vector<Sweep> others = drive(6.0, 1, SensorKind::kVlp16);
  for (int time = 0; time < 2; ++time) {  // not only the first sweep
    try {
      odometry.register_sweep(others[0]);
      ADD_FAILURE() << "not refused";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("calibration: of another sensor"));
    }
  }
  EXPECT_TRUE(odometry.trajectory().empty());
  EXPECT_EQ(odometry.register_sweep(drive(6.0, 1)[0]).status, OdometryStatus::kInitialising);
  EXPECT_NO_THROW(odometry.register_sweep(others[0])) << "one look is enough";
  odometry.start_with(learnt);
  EXPECT_THROW(odometry.register_sweep(others[0]), std::invalid_argument) << "at what is given now";
}

TEST(KnownSensor, SweepsWithoutPointsSayNothing) {
  Odometry odometry(quick());
  odometry.start_with(learnt_from(drive(6.0, 5)));
  EXPECT_EQ(odometry.register_sweep(Sweep{}).status, OdometryStatus::kEmpty);
  EXPECT_THROW(odometry.register_sweep(drive(6.0, 1, SensorKind::kVlp16)[0]), std::invalid_argument);
}

TEST(KnownSensor, AFragmentOfASweepSaysNothing) {
  Odometry odometry(quick());
  odometry.start_with(learnt_from(drive(6.0, 5)));
  const std::vector<Sweep> others = drive(6.0, 2, SensorKind::kVlp16);
  Sweep fragment = others[0];  // a recording begins within a sweep
  fragment.points.resize(50);
  fragment.times_s.resize(50);
  fragment.intensities.resize(50);
  fragment.rings.resize(50);
  EXPECT_NO_THROW(odometry.register_sweep(fragment));
  EXPECT_THROW(odometry.register_sweep(others[1]), std::invalid_argument);
}

TEST(KnownSensor, BeamsThatSawNothingStayAsTheyWere) {
  const SensorAngles learnt = learnt_from(drive(6.0, 6));
  ASSERT_EQ(learnt.beams.size(), 64U);
  std::vector<Sweep> sweeps = drive(20.0, 4);
  for (Sweep& sweep : sweeps) {
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
      if (sweep.rings[i] < 20) sweep.points[i].setZero();
    }
  }
  Odometry known(quick());
  known.start_with(learnt);
  last_pose(known, sweeps);
  for (int pass = 0; pass < 2; ++pass) {
    const SensorAngles after = known.sensor_angles();
    ASSERT_EQ(after.beams.size(), 64U) << "in pass " << pass;
    for (const BeamCorrection& beam : after.beams) {
      const auto before = std::find_if(learnt.beams.begin(), learnt.beams.end(),
                                       [&](const BeamCorrection& b) { return b.beam == beam.beam; });
      if (beam.beam >= 20) continue;
      EXPECT_NEAR(beam.add_elevation_rad, before->add_elevation_rad, 1e-9) << "beam " << beam.beam;
      EXPECT_NEAR(beam.elevation_rad, before->elevation_rad, 0.1 * kRadPerDeg);
    }
    known.start_over();
  }
}

TEST(KnownSensor, BeamsThatAreSwitchedOffStayOff) {
  const std::vector<Sweep> sweeps = drive(6.0, 6);
  OdometryConfig off = quick();
  off.beams.enabled = false;
  Odometry known(off);
  known.start_with(learnt_from(sweeps));
  const SweepStats stats = known.register_sweep(sweeps[0]).stats;
  EXPECT_EQ(stats.beam_elevation_rms_rad, 0.0) << "what is applied, not what is known";
  EXPECT_TRUE(known.sensor_angles().beams.empty());
}

}  // namespace
}  // namespace rilo
