// What a run learns about the sensor is used by another one.
#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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

TEST_F(Calibration, BelongsToDataReadInTheSameWay) {
  rilo_succeeds({"run", data(), "--count", "5", "--out", results(), "--no-report", "--elevation-correction", "-0.3"});
  EXPECT_THAT(slurp(calibration()), HasSubstr("elevation_correction_deg: -0.3 "));
  rilo_fails(2, {"run", data(), "--count", "2", "--calibration", calibration()},
             {calibration().string() + ": learnt from data read with an elevation correction of -0.3 deg",
              "here it is 0 deg. Give the same"});
  rilo_succeeds({"run", data(), "--count", "2", "--calibration", calibration(), "--elevation-correction", "-0.3"});
}

TEST_F(Calibration, OfTheVeryRecordingIsSaid) {
  const std::string warning = calibration().string() + ": learnt from this recording too: errors look smaller";
  const Outcome run = rilo_succeeds(
      {"run", data() / ".", "--count", "2", "--out", out / "same", "--no-report", "--calibration", calibration()});
  EXPECT_THAT(run.err, HasSubstr("warning: " + warning));
  EXPECT_THAT(json_file(out / "same" / "metrics.json")["warnings"].dump(), HasSubstr("learnt from this recording"));
  fs::rename(data(), out / "another");
  const Outcome other = rilo_succeeds(
      {"run", out / "another", "--count", "2", "--out", out / "chain", "--no-report", "--calibration", calibration()});
  EXPECT_THAT(other.err, Not(HasSubstr("this recording")));
  EXPECT_THAT(slurp(out / "chain" / "calibration.yaml"), AllOf(HasSubstr(data().string()), HasSubstr("/another\"")));
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
             {calibration().string() + ": of another sensor, or of data read in another way: "});
  EXPECT_FALSE(fs::exists(out / "others" / "metrics.json"));
}

TEST_F(Calibration, MistakesAreNamed) {
  rilo_fails(2, {"run", data(), "--calibration", out / "none.yaml"}, {"none.yaml", "no such file"});
  rilo_fails(2, {"run", data(), "--calibration", results() / "config.yaml"},
             {"config.yaml, line ", "elevation_sigma_deg and beams"});
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
