// Angles learnt from one sensor are not taken for another one.
#include "calibration/same_sensor.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>

#include "calibration/beam_calibration.hpp"
#include "geometry/degrees.hpp"

namespace rilo {
namespace {

using testing::HasSubstr;
using testing::Optional;

/// Beams from `lowest_deg` upwards, each step_deg above the one before, on a cylinder of 20 m.
Sweep sweep_of(std::size_t beams, double lowest_deg, double step_deg, bool with_rings) {
  Sweep sweep;
  for (int column = 0; column < 100; ++column) {
    const double azimuth = 0.06 * column;
    for (std::size_t beam = 0; beam < beams; ++beam) {
      const double elevation = (lowest_deg + step_deg * static_cast<double>(beam)) * kRadPerDeg;
      sweep.points.push_back(
          Eigen::Vector3d(20 * std::cos(azimuth), 20 * std::sin(azimuth), 20 * std::tan(elevation)).cast<float>());
      if (with_rings) sweep.rings.push_back(static_cast<std::uint16_t>(beam));
    }
  }
  return sweep;
}

/// Angles as they are learnt from that sweep.
SensorAngles learnt_from(const Sweep& sweep) {
  BeamIndex index;
  BeamSample sample;
  index.assign(sweep, sample.beams);
  SensorAngles known;
  std::vector<bool> seen(kBeams, false);
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (seen[sample.beams[i]]) continue;
    seen[sample.beams[i]] = true;
    const Eigen::Vector3f& p = sweep.points[i];
    known.beams.push_back({sample.beams[i], std::atan2(p.z(), p.head<2>().norm()), 0.001, 0.0});
  }
  return known;
}

const auto kRefused = Optional(testing::Not(""));

class SameSensor : public testing::TestWithParam<bool> {};  // with rings

INSTANTIATE_TEST_SUITE_P(Layouts, SameSensor, testing::Bool());

TEST_P(SameSensor, ItsOwnSweepsAreAccepted) {
  for (const auto& [beams, lowest, step] : {std::tuple(16U, -15.0, 2.0), {64U, -16.6, 0.53}, {128U, -22.5, 0.35}}) {
    const Sweep sweep = sweep_of(beams, lowest, step, GetParam());
    EXPECT_EQ(other_sensor(learnt_from(sweep), sweep), "") << beams;
  }
}

TEST_P(SameSensor, AnotherModelIsNot) {
  const SensorAngles known = learnt_from(sweep_of(64, -16.6, 0.53, GetParam()));
  EXPECT_THAT(other_sensor(known, sweep_of(16, -15.0, 2.0, GetParam())), kRefused);
  EXPECT_THAT(other_sensor(known, sweep_of(32, -16.0, 1.0, GetParam())), kRefused);
  EXPECT_THAT(other_sensor(learnt_from(sweep_of(200, -16.0, 0.15, GetParam())), sweep_of(16, -15.0, 2.0, GetParam())),
              kRefused)
      << "beams that fill all ranges";
  EXPECT_THAT(other_sensor(known, sweep_of(64, -24.8, 0.42, GetParam())), Optional(HasSubstr("beam ")));
}

TEST_P(SameSensor, RingsAreNotRangesOfAngles) {
  const SensorAngles known = learnt_from(sweep_of(64, -16.6, 0.53, GetParam()));
  EXPECT_THAT(other_sensor(known, sweep_of(64, -16.6, 0.53, !GetParam())), kRefused);
}

TEST_P(SameSensor, PartsOfItAreAccepted) {
  const SensorAngles known = learnt_from(sweep_of(40, -16.6, 0.53, GetParam()));  // the others saw the sky
  const Sweep all = sweep_of(64, -16.6, 0.53, GetParam());
  EXPECT_EQ(other_sensor(known, all), "");
  EXPECT_EQ(other_sensor(learnt_from(all), sweep_of(20, -16.6, 0.53, GetParam())), "");
}

TEST_P(SameSensor, SomeBeamsThatMeetNothingAreNoDifference) {
  const Sweep all = sweep_of(16, -15.0, 2.0, GetParam());
  Sweep some;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const std::size_t beam = i % 16;
    if (beam >= 5 && beam < 8) continue;
    some.points.push_back(all.points[i]);
    if (GetParam()) some.rings.push_back(all.rings[i]);
  }
  EXPECT_EQ(other_sensor(learnt_from(all), some), "");
}

TEST_P(SameSensor, BeamsThatAllLieElsewhereAreOfAnotherOne) {
  const SensorAngles known = learnt_from(sweep_of(16, 20.0, 2.0, true));
  EXPECT_THAT(other_sensor(known, sweep_of(64, -16.6, 0.53, false)),
              Optional(HasSubstr("beyond those of the calibration")));
}

TEST_P(SameSensor, NothingToCompareIsNoDifference) {
  const Sweep sweep = sweep_of(16, -15.0, 2.0, GetParam());
  EXPECT_EQ(other_sensor({0.01, {}, {}}, sweep), "");
  EXPECT_EQ(other_sensor(learnt_from(sweep), Sweep{}), std::nullopt) << "the next one may say more";
  Sweep bad = sweep;
  for (std::size_t i = 0; i < bad.points.size(); ++i) {
    bad.points[i] = i % 2 == 0 ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                               : Eigen::Vector3f(std::numeric_limits<float>::quiet_NaN(), 1, 1);
  }
  EXPECT_EQ(other_sensor(learnt_from(sweep), bad), std::nullopt);
  SensorAngles beyond;
  beyond.beams.push_back({60000, 0.0, 0.0, 0.0});
  EXPECT_EQ(other_sensor(beyond, Sweep{}), std::nullopt);
}

}  // namespace
}  // namespace rilo
