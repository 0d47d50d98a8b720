// Whether what was known of a sensor counts.
#include "session/dropped_calibration.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "geometry/degrees.hpp"

namespace rilo::test {
namespace {

SensorAngles with_offset(double degrees, double sigma_deg) {
  SensorAngles angles;
  angles.name = "old.yaml";
  angles.elevation_estimate = {kRadPerDeg * degrees, kRadPerDeg * sigma_deg};
  return angles;
}

TEST(DroppedCalibration, IsNamedWhereTheOffsetFoundLiesBeyondTheKnownOnesDeviations) {
  const SensorAngles known = with_offset(0.2, 0.05);
  EXPECT_EQ(dropped_calibration(known, with_offset(0.34, 0.01), 3), "");
  EXPECT_EQ(dropped_calibration(known, with_offset(0.06, 0.01), 3), "");
  EXPECT_EQ(dropped_calibration(known, with_offset(0.36, 0.01), 3),
            "old.yaml: its elevation offset, +0.200 ± 0.050 deg, contradicts this recording, +0.360 ± 0.010 deg, and "
            "does not count: of another unit, or of before a repair?");
  EXPECT_NE(dropped_calibration(known, with_offset(0.04, 0.01), 3), "");
  EXPECT_NE(dropped_calibration(known, with_offset(0.34, 0.01), 2), "");
}

TEST(DroppedCalibration, AnOffsetOfUnknownDeviationIsNotHeldToAnything) {
  const double unknown = std::numeric_limits<double>::infinity();
  EXPECT_EQ(dropped_calibration(with_offset(0, unknown), with_offset(1, 0.01), 3), "");
}

}  // namespace
}  // namespace rilo::test
