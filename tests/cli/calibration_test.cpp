// What a run learns about the sensor is used by another one.
#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

// A short drive of an HDL-64 with an error of 0.3 degrees, and its results.
class Calibration : public testing::Test {
 protected:
  void SetUp() override {
    rilo_succeeds({"simulate", "--out", data(), "--sensor", "hdl64", "--sweeps", "30", "--start", "10",
                   "--elevation-bias", "0.3", "--quiet"});
    rilo_succeeds({"run", data(), "--out", results(), "--no-report"});
  }

  std::filesystem::path data() const { return out / "drive"; }
  std::filesystem::path results() const { return out / "results"; }
  std::filesystem::path calibration() const { return results() / "calibration.yaml"; }

  TempDir out;
};

TEST_F(Calibration, AnotherRunBeginsWithIt) {
  const std::string text = slurp(calibration());
  EXPECT_THAT(text, HasSubstr("learnt from 30 sweeps of "));
  EXPECT_GT(lines_of(text).size(), 60U);
  rilo_succeeds({"run", data(), "--out", out / "plain", "--one-pass", "--no-report"});
  const Outcome run = rilo_succeeds(
      {"run", data(), "--out", out / "known", "--one-pass", "--no-report", "--calibration", calibration()});
  const json plain = json_file(out / "plain" / "metrics.json");
  const json known = json_file(out / "known" / "metrics.json");
  EXPECT_EQ(plain["elevation_given_deg"], 0.0);
  EXPECT_GT(known["elevation_given_deg"], 0.15);
  EXPECT_NEAR(known["elevation_given_deg"].get<double>(),
              json_file(results() / "metrics.json")["elevation_offset_applied_deg"].get<double>(), 1e-6);
  EXPECT_LT(known["evaluation"]["ape_m"]["rmse"], plain["evaluation"]["ape_m"]["rmse"]);
  EXPECT_THAT(run.out, HasSubstr("elevation given +0."));
  EXPECT_THAT(run.out, HasSubstr("calibration     " + calibration().string() + "\n"));
  EXPECT_EQ(known["calibration"], calibration().string());
  EXPECT_TRUE(fs::exists(out / "known" / "calibration.yaml"));
}

TEST_F(Calibration, SaysHowThePointsWereRead) {
  rilo_succeeds({"run", data(), "--out", results(), "--no-report", "--elevation-correction", "-0.3"});
  EXPECT_THAT(slurp(calibration()), HasSubstr("/drive, read with --elevation-correction -0.3.\n"));
}

TEST_F(Calibration, AConfiguredOffsetBesideItIsIgnoredAndSaid) {
  const Outcome run = rilo_succeeds(
      {"run", data(), "--count", "2", "--calibration", calibration(), "--set", "elevation.initial_deg=0.1"});
  EXPECT_THAT(run.err,
              HasSubstr("warning: elevation.initial_deg is ignored: the --calibration says what to begin with"));
}

TEST_F(Calibration, OfAnotherSensorIsRefused) {
  rilo_succeeds({"simulate", "--out", out / "other", "--sensor", "vlp16", "--sweeps", "3", "--quiet"});
  rilo_fails(2, {"run", out / "other", "--out", out / "others", "--calibration", calibration()},
             {"calibration: of another sensor, or of data read in another way: "});
  EXPECT_FALSE(fs::exists(out / "others" / "metrics.json"));
}

TEST_F(Calibration, MistakesAreNamed) {
  rilo_fails(2, {"run", data(), "--calibration", out / "none.yaml"}, {"none.yaml", "no such file"});
  rilo_fails(2, {"run", data(), "--calibration", results() / "config.yaml"},
             {"config.yaml, line ", "elevation_offset_deg, elevation_estimate_deg, elevation_sigma_deg and beams"});
}

TEST_F(Calibration, IsNotReplacedByTheRunThatReadsIt) {
  const std::string before = slurp(calibration());
  rilo_fails(4, {"run", data(), "--out", results(), "--calibration", calibration()}, {"is read by this run"});
  EXPECT_EQ(slurp(calibration()), before);
}

TEST_F(Calibration, NothingLearntNothingLeft) {
  ASSERT_TRUE(fs::exists(calibration()));
  rilo_succeeds({"run", data(), "--out", results(), "--no-report", "--set", "beams.enabled=false"});
  EXPECT_FALSE(fs::exists(calibration())) << "of the run before";
}

}  // namespace
}  // namespace rilo::test
