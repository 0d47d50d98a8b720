// Errors of single beams: found against their neighbours, left alone where they cannot be told.
#include "calibration/beam_calibration.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "registration/registration_scenes.hpp"
#include "rilo/odometry/odometry.hpp"
#include "rilo/simulation/drive_simulator.hpp"
#include "simulation/test_scenes.hpp"

namespace rilo {
namespace {

using test::kDegree;
using test::scene_map_config;

struct Room {
  LocalMap map{scene_map_config()};
  IcpResult icp;
  std::vector<Eigen::Vector3f> points;
};

Room room() {
  Room out;
  SceneSampling sampling;
  sampling.spacing_m = 0.05;
  out.map.set_scene_range(6.0);
  out.map.insert(make_box_room({9.3, 7.1, 3.3}, sampling), SE3::Identity());
  sampling.spacing_m = 0.13;
  out.points = make_box_room({9.3, 7.1, 3.3}, sampling);
  return out;
}

Beam beam_of(const Eigen::Vector3f& p, double step_deg) {
  const double elevation = std::atan2(p.z(), p.head<2>().norm()) / kDegree;
  return static_cast<Beam>(500.0 + std::floor(elevation / step_deg));
}

/// Every beam is off by what `error_deg` says; a hundred sweeps of the same points are learnt from.
template <typename Error>
BeamCalibration learnt(double step_deg, const Error& error_deg) {
  Room scene = room();
  BeamCalibration calibration({true, 0.05});
  BeamAngles wrong;
  BeamSample sample;
  for (const Eigen::Vector3f& p : scene.points) {
    const Beam beam = beam_of(p, step_deg);
    wrong.at(beam) = -static_cast<float>(kDegree) * error_deg(beam);
    sample.beams.push_back(beam);
  }
  for (int sweep = 0; sweep < 100; ++sweep) {
    sample.cloud.points.clear();
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      const Eigen::Vector3f measured = wrong.corrected(scene.points[i], sample.beams[i]);
      sample.cloud.points.push_back(calibration.angles().corrected(measured, sample.beams[i]));
    }
    calibration.learn(sample, scene.map, scene.icp, 0.3, AdaptiveIcpConfig{});
  }
  return calibration;
}

TEST(BeamCalibration, FindsTheErrorsOfAlternatingBeams) {
  const auto error_deg = [](Beam beam) {
    return beam % 2 == 0 ? Eigen::Vector2f(0.06F, 0.04F) : Eigen::Vector2f(-0.06F, -0.04F);
  };
  const BeamCalibration calibration = learnt(0.4, error_deg);
  for (Beam beam = 470; beam < 530; ++beam) {  // within ±12°: walls and edges of floor and ceiling
    const Eigen::Vector2f found = calibration.angles().of(beam) / static_cast<float>(kDegree);
    EXPECT_NEAR(found.y(), error_deg(beam).y(), 0.025F) << beam;
  }
  for (Beam beam = 430; beam < 450; ++beam) {  // 20° and more below the horizon: the floor
    const Eigen::Vector2f found = calibration.angles().of(beam) / static_cast<float>(kDegree);
    EXPECT_NEAR(found.x(), error_deg(beam).x(), 0.02F) << beam;
  }
  EXPECT_GT(calibration.rms_rad().x(), 0.02 * kDegree);
  EXPECT_GT(calibration.rms_rad().y(), 0.02 * kDegree);
}

TEST(BeamCalibration, CorrectionsAreHandedOn) {
  BeamCalibration calibration =
      learnt(0.4, [](Beam beam) { return Eigen::Vector2f(beam % 2 == 0 ? 0.06F : -0.06F, 0.0F); });
  const Eigen::Vector2f angles = calibration.angles().of(440);
  const Eigen::Vector2d rms = calibration.rms_rad();
  ASSERT_FALSE(angles.isZero());
  const double offset_rad = 0.3 * kDegree;  // which these points are taken to have
  const std::vector<BeamCorrection> found = calibration.corrections(offset_rad);
  calibration.begin_with(found, offset_rad);
  EXPECT_EQ(calibration.angles().of(440), angles);
  EXPECT_EQ(calibration.rms_rad(), rms);

  const std::vector<BeamCorrection> again = calibration.corrections(offset_rad);
  ASSERT_EQ(again.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double from_below_deg = 0.4 * (static_cast<double>(found[i].beam) - 500.0) - 0.3;  // of the beam's range
    EXPECT_NEAR(found[i].elevation_rad / kDegree, from_below_deg + 0.2, 0.35) << found[i].beam;
    EXPECT_EQ(again[i].beam, found[i].beam);
    EXPECT_NEAR(again[i].elevation_rad, found[i].elevation_rad, 1e-12);
    EXPECT_EQ(again[i].add_elevation_rad, found[i].add_elevation_rad);
    EXPECT_EQ(again[i].add_azimuth_rad, found[i].add_azimuth_rad);
  }
}

TEST(BeamCalibration, BeamsThatDoNotExistAreIgnored) {
  BeamCalibration calibration(BeamCalibrationConfig{});
  calibration.begin_with({{static_cast<std::uint16_t>(kBeams), 0.1, 0.01, 0.01}, {kNoBeam, 0.1, 0.01, 0.01}}, 0.0);
  EXPECT_TRUE(calibration.corrections(0.0).empty());
  EXPECT_TRUE(calibration.angles().of(kNoBeam).isZero());
}

TEST(BeamCalibration, WhatAllBeamsShareIsLeftAlone) {
  const BeamCalibration calibration = learnt(0.4, [](Beam) { return Eigen::Vector2f(0.06F, 0.04F); });
  EXPECT_LT(calibration.rms_rad().x(), 0.012 * kDegree);
  EXPECT_LT(calibration.rms_rad().y(), 0.025 * kDegree);
}

TEST(BeamCalibration, SparseBeamsAreLeftAlone) {
  const BeamCalibration calibration =
      learnt(2.0, [](Beam beam) { return Eigen::Vector2f(beam % 2 == 0 ? 0.1F : -0.1F, 0.0F); });
  EXPECT_EQ(calibration.rms_rad().norm(), 0.0);
}

TEST(BeamCalibration, FourNeighboursWithinThreeDegreesSuffice) {
  const BeamCalibration calibration =
      learnt(0.9, [](Beam beam) { return Eigen::Vector2f(beam % 2 == 0 ? 0.1F : -0.1F, 0.0F); });
  EXPECT_GT(calibration.rms_rad().x(), 0.03 * kDegree);
}

TEST(BeamCalibration, NothingSeenNothingLearnt) {
  BeamCalibration calibration(BeamCalibrationConfig{});
  calibration.learn({}, LocalMap({}), {}, 0.3, {});
  BeamSample sample;
  sample.cloud.points.assign(50, Eigen::Vector3f(5, 1, -1));
  sample.beams.assign(50, kNoBeam);
  calibration.learn(sample, room().map, {}, 0.3, {});
  EXPECT_EQ(calibration.rms_rad().norm(), 0.0);
  EXPECT_TRUE(calibration.angles().of(3).isZero());
}

TEST(BeamCalibration, APointOnTheAxisHasNoBeam) {
  Room scene = room();
  BeamCalibration calibration({true, 0.05});
  BeamSample sample;
  for (const Eigen::Vector3f& p : scene.points) {
    sample.cloud.points.push_back(p);
    sample.beams.push_back(beam_of(p, 0.4));
  }
  sample.cloud.points.front() = {0.0F, 0.0F, 1.65F};  // on the ceiling, of a beam that others show
  sample.beams.front() = 450;
  calibration.learn(sample, scene.map, scene.icp, 0.3, AdaptiveIcpConfig{});
  EXPECT_TRUE(calibration.rms_rad().allFinite());
  for (std::size_t beam = 0; beam < 1000; ++beam) {
    EXPECT_TRUE(calibration.angles().of(static_cast<Beam>(beam)).allFinite());
  }
  EXPECT_GT(calibration.rms_rad().x(), 0.0) << "the others are learnt";
  for (const BeamCorrection& beam : calibration.corrections(0.0)) {
    EXPECT_TRUE(std::isfinite(beam.elevation_rad)) << beam.beam;
  }
}

/// Drift of a short drive with an HDL-64 whose beams are off by `sigma_deg`, and what was corrected.
SweepStats drive(double sigma_deg, bool enabled, double* corrected_share = nullptr) {
  DriveConfig config;
  config.start_s = 6.0;
  config.sweeps = 15;
  config.sensor = SensorKind::kOs1;
  const DriveSimulator simulator(config);
  std::mt19937 rng(11);
  std::normal_distribution<float> error(0.0F, static_cast<float>(sigma_deg * kDegree) + 1e-12F);
  BeamAngles wrong;
  for (Beam beam = 0; beam < 64; ++beam) {
    wrong.at(beam) = {error(rng), error(rng)};
  }
  OdometryConfig odometry_config;
  odometry_config.beams.gain = 0.2;
  odometry_config.beams.enabled = enabled;
  Odometry odometry(odometry_config);
  SweepStats last;
  for (std::size_t i = 0; i < simulator.size(); ++i) {
    Sweep sweep = simulator.sweep(i).sweep;
    for (std::size_t k = 0; k < sweep.points.size(); ++k) {
      sweep.points[k] = wrong.corrected(sweep.points[k], sweep.rings[k]);
    }
    last = odometry.register_sweep(sweep).stats;
  }
  if (corrected_share != nullptr) {
    *corrected_share = last.beam_elevation_rms_rad / (sigma_deg * kDegree);
  }
  return last;
}

TEST(BeamCalibration, AWorseUnitIsCorrectedMore) {
  double share = 0;
  const SweepStats poor = drive(0.1, true, &share);
  const SweepStats good = drive(0.0, true);
  EXPECT_GT(share, 0.4);
  EXPECT_LT(share, 1.5);
  EXPECT_LT(good.beam_elevation_rms_rad, 0.5 * poor.beam_elevation_rms_rad);
  const SweepStats off = drive(0.1, false);
  EXPECT_EQ(off.beam_elevation_rms_rad, 0.0);
  EXPECT_LT(poor.residual_rms_m, off.residual_rms_m);
}

}  // namespace
}  // namespace rilo
