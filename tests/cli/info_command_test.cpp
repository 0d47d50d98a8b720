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
               {"12 sweeps", "points", "range", "point times", "camera ", "ground truth", "12 poses", "(10.00 Hz)",
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
  // Intensities taken for times.
  expect_parts(rilo_succeeds({"info", folder / "raw" / "velodyne", "--bin-fields", "x,y,z,time"}).out,
               {"these times do not fit", "these are the sweeps of"});
  // Without times, what the run does is clear, too, and there is nothing to choose from.
  for (const char* name : {"raw", "compensated"}) {
    std::filesystem::remove_all(folder / name / "times_pt");
    const std::string text = rilo_succeeds({"info", folder / name}).out;
    expect_parts(text, {"with the times of their order", "finds out that", name});
    EXPECT_EQ(text.find("--point-times"), std::string::npos) << text;
  }
}

TEST(InfoCommand, TheAdviceKeepsTheOptions) {
  const std::string run = "to run it     rilo run '" + shared_drive().string() + "'";
  expect_parts(rilo_succeeds({"info", shared_drive(), "--all", "--point-times", "azimuth", "--skip-bad-sweeps"}).out,
               {run + " --point-times 'azimuth' --skip-bad-sweeps --out results\n"});
  expect_parts(rilo_succeeds({"info", shared_drive()}).out, {run + " --out results\n"});
}

// A hundred and twenty sweeps of two points, 0.1 s apart, of which about fifty are looked at.
std::filesystem::path many_sweeps(const TempDir& folder) {
  std::string stamps;
  for (int i = 0; i < 120; ++i) {
    folder.write("many/velodyne/" + std::to_string(i) + ".bin", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}));
    stamps += std::to_string(i / 10) + "." + std::to_string(i % 10) + "\n";
  }
  folder.write("many/times.txt", stamps);
  return folder / "many";
}

TEST(InfoCommand, TheDurationIsThatOfAllSweeps) {
  const TempDir folder;
  const auto data = many_sweeps(folder);
  expect_parts(rilo_succeeds({"info", data}).out, {"120 sweeps of bin", "for 11.9 s"});
  const auto info = nlohmann::json::parse(rilo_succeeds({"info", data, "--json"}).out);
  EXPECT_EQ(info["sweeps"], 120);
  EXPECT_LT(info["sweeps_read"], 70);
  EXPECT_NEAR(info["stamps"]["span_s"].get<double>(), 11.9, 1e-9);
}

TEST(InfoCommand, ASweepThatCannotBeReadIsNoGap) {
  const TempDir folder;
  const auto data = many_sweeps(folder);
  folder.write("many/velodyne/7.bin", "cut");
  const auto of = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> command = {"info", data, "--json"};
    command.insert(command.end(), flags.begin(), flags.end());
    return nlohmann::json::parse(rilo_succeeds(command).out);
  };
  const auto some = of({});  // without sweep 7
  EXPECT_EQ(some["stamp_faults"]["gaps"], 0);
  EXPECT_TRUE(some["warnings"].empty()) << some["warnings"];
  EXPECT_EQ(of({"--all", "--skip-bad-sweeps"})["bad_sweeps"], 1);
  rilo_fails(3, {"info", data, "--all"}, {"7.bin"});
}

TEST(InfoCommand, SaysWhyNoPointCanBeUsed) {
  const TempDir folder;
  folder.write("mm/0.bin", bytes_of<float>({9000, 0, 0, 0, 0, 9000, 0, 0}));
  expect_parts(rilo_succeeds({"info", folder / "mm"}).out,
               {"no point between 0.5 and 100 m", "median range 9000.000 m", "in metres?"});
  const float nan = std::nanf("");
  folder.write("nan/0.bin", bytes_of<float>({nan, nan, nan, 0}));
  expect_parts(rilo_succeeds({"info", folder / "nan"}).out, {"warning       no finite points"});
  folder.write("none/0.bin", "");
  expect_parts(rilo_succeeds({"info", folder / "none"}).out, {"warning       no points", "1 sweep of bin"});
}

TEST(InfoCommand, ListsTheFieldsAndThoseThatMayHoldTimes) {
  const TempDir folder;
  std::string ply = "ply\nformat ascii 1.0\nelement vertex 2\n";
  for (const char* field : {"x", "y", "z", "ambient", "time_offset"})
    ply += std::string("property float ") + field + "\n";
  folder.write("data/0.ply", ply + "end_header\n1 2 3 4 0\n3 2 1 0 0.1\n");
  const Outcome info = rilo_succeeds({"info", folder / "data"});
  expect_parts(info.out, {"in the data: x y z ambient time_offset; not used: ambient time_offset",
                          "field 'time_offset' is not used", "--time-field 'time_offset'   (if"});
  expect_parts(rilo_succeeds({"info", folder / "data", "--time-field", "time_offset"}).out,
               {"not used: ambient\n", "point times   field time_offset"});
}

TEST(InfoCommand, WithoutPointTimesItAsksWhetherThePointsAreRaw) {
  const TempDir folder;
  const Outcome in_order = rilo_succeeds({"info", long_folder(folder, 3)});
  expect_parts(in_order.out, {"--point-times order   (raw points)", "--point-times none "});
  folder.write("few/0.bin", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}));
  const Outcome few = rilo_succeeds({"info", folder / "few"});
  expect_parts(few.out, {"--point-times azimuth   (raw", "--point-times none "});
}

// 0.7 mm above the sensor or below it, as a driver writes it with the offset of the laser.
TEST(InfoCommand, ReturnsWithoutRangeDoNotHideTheOrder) {
  const TempDir folder;
  std::string bytes;
  for (int i = 0; i < 6000; ++i) {
    const float angle = 0.001F * static_cast<float>(i);
    const bool returned = i % 5 < 2;
    bytes += returned ? bytes_of<float>({9.0F * std::cos(angle), 9.0F * std::sin(angle), 1.0F, 0.0F})
                      : bytes_of<float>({0.0F, 0.0F, i % 2 == 0 ? 0.0007F : -0.0007F, 0.0F});
  }
  folder.write("data/0.bin", bytes);
  const std::string text = rilo_succeeds({"info", folder / "data"}).out;
  expect_parts(text, {"3600 within 0.1 m of the sensor's axis", "--point-times order   (raw points)"});
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
