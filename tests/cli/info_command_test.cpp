// rilo info.
#include <cmath>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

TEST(InfoCommand, JsonOfADrive) {
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", shared_drive(), "--json"}).out);
  EXPECT_EQ(info["sweeps"], kDriveSweeps);
  EXPECT_EQ(info["sweeps_read"], kDriveSweeps);
  EXPECT_GT(info["points"]["min"], 1000);
  EXPECT_LE(info["points"]["min"], info["points"]["max"]);
  EXPECT_EQ(info["points"]["not_finite"], 0);
  EXPECT_LT(info["range_m"]["p5"], info["range_m"]["p95"]);
  EXPECT_NEAR(info["stamps"]["period_s"].get<double>(), 0.1, 1e-3);
  EXPECT_NE(info["point_times"]["source"].get<std::string>().find("times_pt"), std::string::npos);
  EXPECT_EQ(info["calibration"], true);
  EXPECT_EQ(info["truth"]["poses"], kDriveSweeps);
  EXPECT_EQ(info["bad_sweeps"], 0);
  EXPECT_EQ(info["elevation_correction_deg"], 0.0);
}

TEST(InfoCommand, TextOfADrive) {
  const Outcome info = rilo_succeeds({"info", shared_drive()});
  expect_parts(info.out,
               {"12 sweeps", "points", "range", "point times", "calibration", "ground truth", "12 poses", "(10.00 Hz)",
                "from 0.0", "for 1.1 s", "intensity: yes; ring: no", "to run it", "--out results"});
  EXPECT_EQ(info.err, "");
}

TEST(InfoCommand, SaysWhetherPointsAreRaw) {
  const TempDir folder;
  const auto of = [&folder](const char* name, const std::vector<std::string>& flags) {
    std::vector<std::string> simulate = {"simulate", "--out", folder / name, "--sensor", "vlp16",
                                         "--sweeps", "25",    "--start",     "10",       "--quiet"};
    simulate.insert(simulate.end(), flags.begin(), flags.end());
    rilo_succeeds(simulate);
    return rilo_succeeds({"info", folder / name}).out;
  };
  expect_parts(of("raw", {}), {"of 22 sweeps fit better", "raw points"});
  expect_parts(of("compensated", {"--deskewed"}), {"of 22 sweeps fit better", "compensated already"});
  // Compensated, but with times: as some data sets are.
  std::filesystem::copy(folder / "raw" / "times_pt", folder / "compensated" / "times_pt");
  expect_parts(rilo_succeeds({"info", folder / "compensated"}).out,
               {"compensated already", "--out results --point-times none\n"});
  EXPECT_EQ(rilo_succeeds({"info", folder / "raw", "--point-times", "none"}).out.find("motion  "), std::string::npos);
}

TEST(InfoCommand, WithoutPointTimesItAsksWhetherThePointsAreRaw) {
  const TempDir folder;
  const Outcome in_order = rilo_succeeds({"info", long_folder(folder, 3)});
  expect_parts(in_order.out, {"finds out", "--point-times order   (they are)", "--point-times none "});
  folder.write("few/0.bin", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}));
  const Outcome few = rilo_succeeds({"info", folder / "few"});
  expect_parts(few.out, {"--point-times azimuth   (raw", "--point-times none "});
}

// A window that the sensor looks through is not: its sweeps see the same directions.
TEST(InfoCommand, SaysThatSweepsArePartsOfARevolution) {
  for (const bool in_turn : {true, false}) {
    const TempDir folder;
    for (int i = 0; i < 120; ++i) {
      std::string bytes;
      for (int k = 0; k < 90; ++k) {
        const float angle = 0.034F * static_cast<float>(k) + (in_turn && i % 2 == 1 ? 3.15F : 0.0F);
        bytes +=
            bytes_of<float>({10.0F * std::cos(angle), 10.0F * std::sin(angle), 0.1F * static_cast<float>(i), 0.0F});
      }
      folder.write("halves/" + std::to_string(i) + ".bin", bytes);
    }
    const std::string text = rilo_succeeds({"info", folder / "halves"}).out;
    EXPECT_EQ(text.find("part of a revolution") != std::string::npos, in_turn) << text;
    EXPECT_NE(text.find(in_turn ? "in one sweep, 360° in all" : "180° in one sweep, 180° in all"), std::string::npos)
        << text;
  }
}

TEST(InfoCommand, SaysWhatIsWrongWithTheTruth) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  replace(drive / "poses_mid.txt", "no poses\n");
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", drive, "--json"}).out);
  EXPECT_NE(info["truth"]["error"].get<std::string>().find("poses_mid.txt"), std::string::npos);
}

TEST(InfoCommand, MissingAndEmptyData) {
  const TempDir folder;
  rilo_fails(3, {"info", folder / "nowhere"}, {"nowhere"});
  rilo_fails(3, {"info", folder.path()}, {folder.path()});
}

}  // namespace
}  // namespace rilo::test
