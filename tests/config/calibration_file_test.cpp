// calibration.yaml: what is written is read again, anything else is refused with its place.
#include "rilo/config/calibration_file.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDegree = std::numbers::pi / 180.0;

SensorAngles some_angles() {
  SensorAngles angles;
  angles.elevation_offset_rad = -0.205 * kDegree;
  angles.elevation_estimate = {-0.2 * kDegree, 0.04 * kDegree};
  angles.beams = {{0, -24.8 * kDegree, 0.012345 * kDegree, -0.06 * kDegree}, {1023, 15.0 * kDegree, 0.0, 0.0}};
  angles.elevation_correction_deg = -0.3;
  angles.recordings = {"/drives/a: \"b\" # c", "/drives/d\ne"};
  return angles;
}

std::string refusal(const std::string& yaml) {
  try {
    parse_calibration(yaml, "c.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "not refused: " << yaml;
  return {};
}

TEST(CalibrationFile, WhatIsWrittenIsRead) {
  const test::TempDir folder;
  const std::string text = dump_calibration(some_angles(), "60 sweeps of a: \"b\"\nc # d");
  const SensorAngles read = load_calibration(folder.write("c.yaml", text));
  EXPECT_NEAR(read.elevation_offset_rad, some_angles().elevation_offset_rad, 1e-6 * kDegree);
  EXPECT_NEAR(read.elevation_estimate.rad, -0.2 * kDegree, 1e-6 * kDegree);
  EXPECT_NEAR(read.elevation_estimate.sigma_rad, 0.04 * kDegree, 1e-6 * kDegree);
  ASSERT_EQ(read.beams.size(), 2U);
  EXPECT_EQ(read.beams[0].beam, 0);
  EXPECT_EQ(read.beams[1].beam, 1023);
  EXPECT_NEAR(read.beams[0].elevation_rad, -24.8 * kDegree, 1e-4 * kDegree);
  EXPECT_NEAR(read.beams[0].add_elevation_rad, 0.012345 * kDegree, 1e-6 * kDegree);
  EXPECT_NEAR(read.beams[0].add_azimuth_rad, -0.06 * kDegree, 1e-6 * kDegree);
  EXPECT_EQ(read.elevation_correction_deg, -0.3);
  EXPECT_EQ(read.recordings, some_angles().recordings);
  EXPECT_EQ(read.name, (folder.path() / "c.yaml").string());
  EXPECT_EQ(dump_calibration(read, "60 sweeps of a: \"b\" c # d"), text);
  const SensorAngles empty = parse_calibration(dump_calibration({}, ""), "empty");
  EXPECT_TRUE(empty.beams.empty());
  EXPECT_FALSE(empty.elevation_correction_deg) << "not known";
  EXPECT_TRUE(std::isinf(empty.elevation_estimate.sigma_rad)) << "nothing is known";
}

TEST(CalibrationFile, WhatIsLeftCanBeRead) {
  SensorAngles angles = some_angles();  // of a few sweeps that say next to nothing
  angles.elevation_estimate = {15.0 * kDegree, 120.0 * kDegree};
  EXPECT_TRUE(std::isinf(parse_calibration(dump_calibration(angles, ""), "c.yaml").elevation_estimate.sigma_rad));
  angles.elevation_estimate = {5.0 * kDegree, 120.0 * kDegree};
  EXPECT_NEAR(parse_calibration(dump_calibration(angles, ""), "c.yaml").elevation_estimate.rad, 5.0 * kDegree, 1e-6);
}

TEST(CalibrationFile, MistakesAreNamedWithTheirPlace) {
  const std::string offset = "elevation_offset_deg: 0.1\n";
  EXPECT_THAT(refusal(""), HasSubstr("calibration.yaml as rilo run leaves it"));
  EXPECT_THAT(refusal("[1, 2]"), HasSubstr("a list"));
  EXPECT_THAT(refusal(offset), HasSubstr("no beams"));
  EXPECT_THAT(refusal("beams: []"), HasSubstr("no elevation_offset_deg"));
  EXPECT_THAT(refusal("elevation_offset_deg: 12\nbeams: []"),
              HasSubstr("line 1, column 23: elevation_offset_deg is \"12\"; expected a number from -10 to 10"));
  EXPECT_THAT(refusal("elevation_offset_deg: nan\nbeams: []"), HasSubstr("\"nan\""));
  EXPECT_THAT(refusal("elevation_offset_deg: 0.1 deg\nbeams: []"), HasSubstr("\"0.1 deg\""));
  EXPECT_THAT(refusal(offset + "beam: []"), HasSubstr("unknown key \"beam\""));
  EXPECT_THAT(refusal(offset + offset + "beams: []"), HasSubstr("a second time"));
  EXPECT_THAT(refusal(offset + "elevation_estimate_deg: 0.1\nbeams: []"), HasSubstr("expected both or none"));
  EXPECT_THAT(refusal(offset + "elevation_estimate_deg: 0.1\nelevation_sigma_deg: 0\nbeams: []"),
              HasSubstr("elevation_sigma_deg is \"0\"; expected a number from 0.0001 to 90"));
  EXPECT_THAT(refusal(offset + "beams: 3"), HasSubstr("beams is \"3\"; expected a list of beams"));
  EXPECT_THAT(refusal(offset + "beams: [[1, 2, 3]]"), HasSubstr("expected [beam, elevation,"));
  EXPECT_THAT(refusal(offset + "beams: [[1.5, 0, 0, 0]]"), HasSubstr("\"1.5\"; expected a whole number"));
  EXPECT_THAT(refusal(offset + "beams: [[1024, 0, 0, 0]]"), HasSubstr("from 0 to 1023"));
  EXPECT_THAT(refusal(offset + "beams: [[1, 91, 0, 0]]"), HasSubstr("an elevation is \"91\""));
  EXPECT_THAT(refusal(offset + "beams: [[1, 0, 2.1, 0]]"), HasSubstr("a correction is \"2.1\""));
  EXPECT_THAT(refusal(offset + "beams: [[1, 0, 0, inf]]"), HasSubstr("a correction is \"inf\""));
  EXPECT_THAT(refusal(offset + "beams: [[1, 0, 0, 0], [1, 1, 0, 0]]"), HasSubstr("beam 1 a second time"));
  EXPECT_THAT(refusal(offset + "beams: [[1, [], 0, 0]]"), StartsWith("c.yaml, line 2, column 13: "));
  EXPECT_THAT(refusal(offset + "recordings: here\nbeams: []"), HasSubstr("expected a list of paths"));
  EXPECT_THROW(load_calibration("/no/such/file.yaml"), ConfigError);
}

TEST(CalibrationFile, CutOffAtTheEndOfALineItIsRefused) {
  const std::string text = dump_calibration(some_angles(), "a drive");
  EXPECT_THAT(refusal(text.substr(0, text.find("  - [1023"))),
              StartsWith("c.yaml: the end is missing; expected a last line \"...\". It is cut off: copy it again"));
  EXPECT_NO_THROW(parse_calibration(text + "\n \n", "blank lines"));
}

TEST(CalibrationFile, WhateverTheBytes) {
  std::mt19937 random(3);
  const std::string text = dump_calibration(some_angles(), "a drive");
  const auto is_taken = [](const std::string& yaml) {
    try {
      parse_calibration(yaml, "hostile");
      return true;
    } catch (const ConfigError&) {
      return false;
    }
  };
  ASSERT_TRUE(is_taken(text));
  for (std::size_t length = 0; length < text.rfind("\n...") + 4; ++length) {
    EXPECT_FALSE(is_taken(text.substr(0, length))) << text.substr(0, length);
  }
  for (int round = 0; round < 2000; ++round) {
    std::string broken = text;
    for (int i = 0; i < 3; ++i) broken[random() % broken.size()] = static_cast<char>(random() % 256);
    is_taken(broken);
  }
}

}  // namespace
}  // namespace rilo
