// Raw or compensated, by the cones of the beams.
#include "session/beam_cones.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/degrees.hpp"

namespace rilo::test {
namespace {

constexpr double kTurnS = 0.1;
constexpr int kColumns = 1000;

/// 16 beams of 2° from -15° on, on a flat road 1.7 m below and on walls 8 m to the left and the right.
Sweep road_sweep() {
  Sweep sweep;
  for (int c = 0; c < kColumns; ++c) {
    const double azimuth = std::numbers::pi - 2.0 * std::numbers::pi * (c + 0.5) / kColumns;
    for (int beam = 0; beam < 16; ++beam) {
      const double elevation = kRadPerDeg * (2.0 * beam - 15.0);
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double to_wall = 8.0 / std::max(std::abs(ray.y()), 0.01);
      const double to_road = ray.z() < 0 ? -1.7 / ray.z() : 1e9;
      sweep.points.emplace_back((std::min(to_wall, to_road) * ray).cast<float>());
      sweep.times_s.push_back(static_cast<float>(kTurnS * c / kColumns));
    }
  }
  return sweep;
}

const Vector6d& driving() {
  static const Vector6d kTwist = (Vector6d() << 0, 0, 0.1, 8, 0, 0).finished();
  return kTwist;
}

/// Compensated to that share of the sweep.
Sweep compensated_sweep(double reference) {
  Sweep sweep = road_sweep();
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const double since_s = static_cast<double>(sweep.times_s[i]) - reference * kTurnS;
    sweep.points[i] = (se3_exp(since_s * driving()) * sweep.points[i].cast<double>()).cast<float>();
  }
  return sweep;
}

TEST(BeamCones, RawPointsLieOnThem) { EXPECT_EQ(on_beam_cones(road_sweep(), driving()), ConeVerdict::kRaw); }

TEST(BeamCones, CompensatedOnesDoNotWhateverTheReference) {
  for (const double reference : {0.0, 0.5, 1.0}) {
    EXPECT_EQ(on_beam_cones(compensated_sweep(reference), driving()), ConeVerdict::kCompensated) << reference;
  }
}

TEST(BeamCones, NothingFromATurnARestOrATiltedFrame) {
  const Vector6d turning = (Vector6d() << 0, 0, 2, 0, 0, 0).finished();
  EXPECT_EQ(on_beam_cones(road_sweep(), turning), ConeVerdict::kNothing);
  EXPECT_EQ(on_beam_cones(road_sweep(), Vector6d::Zero()), ConeVerdict::kNothing);
  const Eigen::AngleAxisf tilt(0.3F, Eigen::Vector3f::UnitY());
  for (Sweep sweep : {road_sweep(), compensated_sweep(0.5)}) {
    for (Eigen::Vector3f& p : sweep.points) p = tilt * p + Eigen::Vector3f(0.5F, 0, 1);
    EXPECT_EQ(on_beam_cones(sweep, driving()), ConeVerdict::kNothing);
  }
}

TEST(BeamCones, NothingFromFewPoints) {
  EXPECT_EQ(on_beam_cones({}, driving()), ConeVerdict::kNothing);
  Sweep far = road_sweep();
  for (Eigen::Vector3f& p : far.points) p *= 20.0F;
  EXPECT_EQ(on_beam_cones(far, driving()), ConeVerdict::kNothing);
}

TEST(BeamCones, PointsAndTimesThatAreNoneDoNotCount) {
  for (const double reference : {-1.0, 0.5}) {
    Sweep sweep = reference < 0 ? road_sweep() : compensated_sweep(reference);
    const ConeVerdict without = on_beam_cones(sweep, driving());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < 5000; ++i) {
      sweep.points.emplace_back(i % 2 == 0 ? Eigen::Vector3f::Zero() : Eigen::Vector3f(nan, 0, 0));
      sweep.times_s.push_back(0.0F);
      sweep.points.emplace_back(3.0F, 0.1F * static_cast<float>(i % 50), 0);
      sweep.times_s.push_back(nan);
    }
    EXPECT_EQ(on_beam_cones(sweep, driving()), without);
  }
}

}  // namespace
}  // namespace rilo::test
