// When the sweeps of a folder were taken: by their names, by files beside them, by their numbers.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/folders/stamp_list.hpp"
#include "io/io_test_util.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {
namespace {

std::vector<std::int64_t> stamps_of(const std::filesystem::path& path) {
  std::vector<std::int64_t> stamps;
  const auto source = open_scan_source(path);
  while (const auto sweep = source->next()) stamps.push_back(sweep->stamp_ns);
  return stamps;
}

TEST(FolderStampsTest, StampsFromTheNamesOrTheTimesFile) {
  const TempDir folder;
  folder.write("n/1326652795280148.bin", bin_of(1));
  folder.write("n/1326652795480148.bin", bin_of(2));
  EXPECT_EQ(open_scan_source(folder / "n")->next()->stamp_ns, 1'326'652'795'280'148'000);
  EXPECT_NEAR(open_scan_source(folder / "n")->info().period_s, 0.2, 1e-6);
  folder.write("s/1326652795.5.bin", bin_of(1));
  EXPECT_EQ(open_scan_source(folder / "s")->next()->stamp_ns, 1'326'652'795'500'000'000);
  folder.write("d/1673400472138016708.pcd.bin", bin_of(1));
  EXPECT_EQ(open_scan_source(folder / "d")->next()->stamp_ns, 1'673'400'472'138'016'708);
  folder.write("t/1.bin", bin_of(1));
  folder.write("t/times.txt", "77.5\n");
  EXPECT_EQ(open_scan_source(folder / "t")->next()->stamp_ns, 77'500'000'000);
}

TEST(FolderStampsTest, StampsAmongOtherThingsInTheNames) {
  const TempDir folder;
  // As nuScenes names them; the log of another day was earlier.
  folder.write("n/n008-2018-08-28-16-43-51-0400__LIDAR_TOP__1535489306946930.pcd.bin", bin_of(1));
  folder.write("n/n015-2018-07-24-11-22-45+0800__LIDAR_TOP__1532402927647951.pcd.bin", bin_of(1));
  folder.write("n/n015-2018-07-24-11-22-45+0800__LIDAR_TOP__1532402928147847.pcd.bin", bin_of(1));
  EXPECT_EQ(stamps_of(folder / "n"), (std::vector<std::int64_t>{1'532'402'927'647'951'000, 1'532'402'928'147'847'000,
                                                                1'535'489'306'946'930'000}));
  folder.write("c/cloud.1700000000.5.pcd.bin", bin_of(1));
  EXPECT_EQ(stamps_of(folder / "c"), std::vector<std::int64_t>{1'700'000'000'500'000'000});
  folder.write("nc/cloud_1583836591_182590976.pcd", "");
  folder.write("nc/cloud_1583836591_082590976.pcd", "");
  EXPECT_NEAR(open_scan_source(folder / "nc")->info().period_s, 0.1, 1e-9);
  folder.write("av/PC_315968385323560000.bin", bin_of(1));
  EXPECT_EQ(stamps_of(folder / "av"), std::vector<std::int64_t>{315'968'385'323'560'000});
  folder.write("us/1583836591_182590.bin", bin_of(1));
  EXPECT_TRUE(open_scan_source(folder / "us")->info().stamps_assumed);
  // Two of them are none, and so is a number that is too short.
  folder.write("two/1535489306946930_1535489306996930.bin", bin_of(1));
  EXPECT_TRUE(open_scan_source(folder / "two")->info().stamps_assumed);
  folder.write("short/scan_153548930694693.bin", bin_of(1));
  EXPECT_TRUE(open_scan_source(folder / "short")->info().stamps_assumed);
}

TEST(FolderStampsTest, NamesOfDecimalSecondsInTheOrderOfTime) {
  const TempDir folder;
  for (const char* name : {"1700000000.4234936", "1700000000.523506", "1700000000.6235182", "1700000000.05"}) {
    folder.write("s/" + std::string(name) + ".bin", bin_of(1));
  }
  const auto source = open_scan_source(folder / "s");
  std::vector<std::int64_t> hundredths;
  while (const auto sweep = source->next())
    hundredths.push_back((sweep->stamp_ns - 1'700'000'000'000'000'000) / 10'000'000);
  EXPECT_EQ(hundredths, (std::vector<std::int64_t>{5, 42, 52, 62}));
  EXPECT_FALSE(source->info().stamps_assumed);
}

TEST(FolderStampsTest, StampsFromTimestampsBesideOrAbove) {
  const std::vector<std::int64_t> kExpected{1'317'042'145'951'199'337, 1'317'042'146'054'503'000};
  for (const char* text :
       {"2011-09-26 13:02:25.951199337\n2011-09-26 13:02:26.054503000\n",
        "# ns\n1317042145951199337\n\n1317042146054503000\n", "1317042145.951199337\n1317042146.054503\n"}) {
    for (const char* place : {"d/lidar/timestamps.txt", "d/times.txt", "d/timestamps.txt"}) {
      SCOPED_TRACE(std::string(place) + ": " + text);
      const TempDir folder;
      folder.write("d/lidar/1.bin", bin_of(1));
      folder.write("d/lidar/2.bin", bin_of(2));
      folder.write(place, text);
      EXPECT_EQ(stamps_of(folder / "d/lidar"), kExpected);
      EXPECT_TRUE(open_scan_source(folder / "d/lidar")->info().warnings.empty());
    }
  }
}

TEST(FolderStampsTest, DatesWithoutLeadingZeros) {
  const TempDir folder;
  folder.write("1.bin", bin_of(1));
  folder.write("2.bin", bin_of(2));
  for (const char* text :
       {"2011-09-26 09:02:59.500\n2011-09-26 09:03:05.25\n", "2011-9-26 9:02:59.500\n2011-9-26 9:3:5.25\n",
        "2011-09-26 9:02:59.500\n2011-09-26 9:03:05.25\n"}) {
    folder.write("timestamps.txt", text);
    EXPECT_EQ(stamps_of(folder.path()),
              (std::vector<std::int64_t>{1'317'027'779'500'000'000, 1'317'027'785'250'000'000}))
        << text;
  }
  for (const char* line : {"2011-9-26 9:02:", "2011-9-26 9:02", "2011-9-26 9:02:x", "2011-9-26 9:02:99",
                           "2011-9-26 9:02: 5", "2011-9-026 13:02:25", "11-9-26 9:02:59"}) {
    folder.write("timestamps.txt", std::string(line) + "\n2011-9-26 9:03:05\n");
    EXPECT_TRUE(has_warning(open_scan_source(folder.path())->info(),
                            "timestamps.txt, line 1: '" + std::string(line) + "'; expected a date"))
        << line;
  }
}

TEST(FolderStampsTest, TimestampsThatDoNotFitAreNamed) {
  const TempDir folder;
  folder.write("d/lidar/1.bin", bin_of(1));
  folder.write("d/timestamps.txt", "0.5\n0.6\n");
  folder.write("d/lidar/timestamps.txt", "noon\n");
  const auto info = open_scan_source(folder / "d/lidar")->info();
  EXPECT_TRUE(info.stamps_assumed);
  EXPECT_TRUE(has_warning(info, "d/timestamps.txt: 2 stamps for 1 sweep"));
  EXPECT_TRUE(has_warning(info, "lidar/timestamps.txt, line 1: 'noon'"));
  EXPECT_TRUE(has_warning(info, "no timestamps found; assuming 10 Hz"));
  // A KITTI sequence has its times beside velodyne/; what lies above that is of other data.
  folder.write("s/00/velodyne/1.bin", bin_of(1));
  folder.write("s/timestamps.txt", "0.5\n");
  EXPECT_EQ(stamps_of(folder / "s/00"), std::vector<std::int64_t>{0});
  folder.write("s/00/timestamps.txt", "0.5\n");
  EXPECT_EQ(stamps_of(folder / "s/00"), std::vector<std::int64_t>{500'000'000});
}

// Sweeps whose points have times since 1970; each begins so long after the year 2023.
void write_with_epoch_times(const TempDir& folder, const std::vector<double>& begins_s, double point_step_s) {
  for (std::size_t k = 0; k < begins_s.size(); ++k) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 60\nproperty float x\nproperty float y\n"
        "property float z\nproperty double t\nend_header\n";
    for (std::size_t i = 0; i < 60; ++i) {
      const double time_s = 1.7e9 + begins_s[k] + point_step_s * static_cast<double>(i);
      text += std::to_string(1 + i) + " 2 3 " + std::to_string(time_s) + "\n";
    }
    folder.write(std::to_string(k) + ".ply", text);
  }
}

TEST(FolderStampsTest, TimesThatPointsAreNotToHaveStampTheirSweepsAllTheSame) {
  const TempDir folder;
  write_with_epoch_times(folder, {0, 0.5, 1.0, 1.5}, 0.001);
  for (const PointTimes how : {PointTimes::kAuto, PointTimes::kNone}) {
    SourceOptions options;
    options.point_times = how;
    const auto source = open_scan_source(folder.path(), options);
    const auto sweeps = sweeps_of(*source);
    EXPECT_FALSE(source->info().stamps_assumed);
    EXPECT_FALSE(has_warning(source->info(), "no timestamps found"));
    ASSERT_EQ(sweeps.size(), 4U);
    for (const Sweep& sweep : sweeps) EXPECT_EQ(sweep.times_s.empty(), how == PointTimes::kNone);
    EXPECT_NEAR(1e-9 * static_cast<double>(sweeps[3].stamp_ns - sweeps[0].stamp_ns), 1.5, 1e-5);
  }
}

TEST(FolderStampsTest, StampsOfThePointsShowThePeriod) {
  const TempDir folder;
  write_with_epoch_times(folder, {0, 0.41, 0.82, 1.23}, 0.001);
  const auto source = open_scan_source(folder.path());
  EXPECT_NEAR(source->info().period_s, 0.41, 1e-6);
  EXPECT_EQ(sweeps_of(*source).size(), 4U);
  EXPECT_FALSE(has_warning(source->info(), "a gap of"));
}

// A slow sensor without stamps.
TEST(FolderStampsTest, SweepsThatLastLongerThanTheAssumedPeriodShowIt) {
  const TempDir folder;
  const auto period_of = [&](double length_s, std::optional<double> rate_hz = std::nullopt) {
    for (const char* name : {"0.ply", "1.ply", "2.ply"}) {
      std::string text =
          "ply\nformat ascii 1.0\nelement vertex 101\nproperty float x\nproperty float y\n"
          "property float z\nproperty float t\nend_header\n";
      for (int i = 0; i <= 100; ++i) {
        text += std::to_string(1 + i) + " 2 3 " + std::to_string(length_s * i / 100) + "\n";
      }
      folder.write(name, text);
    }
    SourceOptions options;
    options.rate_hz = rate_hz;
    const auto source = open_scan_source(folder.path(), options);
    const auto sweeps = sweeps_of(*source);
    EXPECT_NEAR(1e-9 * static_cast<double>(sweeps.at(2).stamp_ns), 2 * source->info().period_s, 1e-9);
    EXPECT_EQ(sweeps.at(0).times_s.size(), 101U);
    EXPECT_EQ(has_warning(source->info(), "since a sweep lasts"), length_s > 0.2 && !rate_hz);
    return source->info().period_s;
  };
  EXPECT_NEAR(period_of(0.41), 0.41, 1e-6);
  EXPECT_DOUBLE_EQ(period_of(0.1), 0.1);
  EXPECT_DOUBLE_EQ(period_of(0.05), 0.1) << "a window of a sweep, perhaps";
  EXPECT_DOUBLE_EQ(period_of(0.41, 4), 0.25);
}

TEST(FolderStampsTest, TimesThatMakeNoSenseAreNoErrorWherePointsAreNotToHaveThem) {
  const TempDir folder;
  write_with_epoch_times(folder, {0, 0.5, 1.0}, 1e7);
  EXPECT_THROW(sweeps_of(*open_scan_source(folder.path())), IoError);
  SourceOptions options;
  options.point_times = PointTimes::kNone;
  const auto source = open_scan_source(folder.path(), options);
  const auto sweeps = sweeps_of(*source);
  EXPECT_TRUE(source->info().stamps_assumed);
  EXPECT_TRUE(has_warning(source->info(), "no timestamps found"));
  ASSERT_EQ(sweeps.size(), 3U);
  EXPECT_EQ(sweeps[2].stamp_ns, 200'000'000);
  EXPECT_TRUE(sweeps[2].times_s.empty());
}

TEST(FolderStampsTest, StampsThatGoBackAskForTheOrderOfTheNames) {
  const TempDir folder;
  write_with_epoch_times(folder, {0, 0.1, 2.1, 0.2}, 0.001);  // 0, 1, 10, 2 became 0, 1, 2, 3
  const auto source = open_scan_source(folder.path());
  EXPECT_EQ(sweeps_of(*source).size(), 4U);
  EXPECT_TRUE(has_warning(source->info(), "taken as a clock that was set; or are the files not named in the order of"));
}

TEST(FolderStampsTest, WithoutStampsNumbersTellWhichSweepsAreMissing) {
  const auto steps_of = [](const std::vector<std::string>& names) {
    const TempDir folder;
    for (const std::string& name : names) folder.write(name, bytes_of<float>({1, 2, 3, 4}));
    SourceOptions options;
    options.rate_hz = 20;
    const auto source = open_scan_source(folder.path(), options);
    std::vector<std::int64_t> steps;
    std::int64_t before = source->next()->stamp_ns;
    while (const auto sweep = source->next()) {
      steps.push_back((sweep->stamp_ns - before) / 50'000'000);
      before = sweep->stamp_ns;
    }
    EXPECT_TRUE(source->info().stamps_assumed);
    return steps;
  };
  using Steps = std::vector<std::int64_t>;
  EXPECT_EQ(steps_of({"7.bin", "8.bin", "11.bin", "12.bin"}), (Steps{1, 3, 1}));
  EXPECT_EQ(steps_of({"scan_000.bin", "scan_005.bin", "scan_015.bin", "scan_020.bin"}), (Steps{1, 2, 1}));
  EXPECT_EQ(steps_of({"0001_a.bin", "0002_a.bin", "0004_a.bin"}), (Steps{1, 2}));
  // Numbers that may mean something else.
  EXPECT_EQ(steps_of({"1.bin", "2.bin", "40.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"a1.bin", "b2.bin", "b4.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"a.bin", "b.bin"}), (Steps{1}));
  EXPECT_EQ(steps_of({"1_1.bin", "1_2.bin", "2_1.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"1234567890.bin", "1234567891.bin", "1234567893.bin"}), (Steps{1, 1}));
  EXPECT_EQ(steps_of({"01.bin", "1.bin", "3.bin"}), (Steps{1, 1}));
}

TEST(StampListTest, DigitsTellTheUnit) {
  EXPECT_EQ(detail::parse_long_stamp("1700000000123456789"), 1'700'000'000'123'456'789);
  EXPECT_EQ(detail::parse_long_stamp("1700000000123456"), 1'700'000'000'123'456'000);
  EXPECT_EQ(detail::parse_long_stamp("1700000000123"), 1'700'000'000'123'000'000);
  EXPECT_FALSE(detail::parse_long_stamp("0000000000123")) << "a number";
  EXPECT_FALSE(detail::parse_long_stamp("1700000000"));
  EXPECT_FALSE(detail::parse_long_stamp("9999999999999999"));
}

}  // namespace
}  // namespace rilo::test
