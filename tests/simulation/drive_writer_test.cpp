#include "simulation/drive_writer.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/drive_path.hpp"

namespace rilo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class DriveWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::path(testing::TempDir()) / "rilo_drive_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
    folder_ = root_ / "a" / "drive";
  }
  void TearDown() override { fs::remove_all(root_); }

  static DriveConfig config(std::size_t sweeps, bool deskewed) {
    DriveConfig c;
    c.sensor = SensorKind::kVlp16;
    c.sweeps = sweeps;
    c.start_s = 7;
    c.deskewed = deskewed;
    c.threads = 1;
    return c;
  }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<float> floats(const std::string& name) const {
    const std::string bytes = text(name);
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
  }
  std::vector<std::vector<double>> rows(const std::string& name) const {
    std::istringstream all(text(name));
    std::vector<std::vector<double>> result;
    for (std::string line; std::getline(all, line);) {
      std::istringstream numbers(line);
      result.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
    }
    return result;
  }

  fs::path root_, folder_;
};

TEST_F(DriveWriterTest, RawDriveCanBeReadBack) {
  const DriveSimulator drive(config(3, false));
  const DriveSummary summary = write_drive(drive, folder_);
  EXPECT_EQ(summary.sweeps, 3U);
  std::size_t points = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const SimulatedSweep s = drive.sweep(i);
    const std::string name = "00000" + std::to_string(i) + ".bin";
    const std::vector<float> values = floats("velodyne/" + name);
    const std::vector<float> fractions = floats("times_pt/" + name);
    ASSERT_EQ(values.size(), 4 * s.sweep.points.size());
    ASSERT_EQ(fractions.size(), s.sweep.points.size());
    points += fractions.size();
    for (std::size_t k = 0; k < fractions.size(); k += 97) {
      EXPECT_EQ(Eigen::Vector3f(values[4 * k], values[4 * k + 1], values[4 * k + 2]), s.sweep.points[k]);
      EXPECT_EQ(values[4 * k + 3], s.sweep.intensities[k]);
      EXPECT_NEAR(fractions[k], s.sweep.times_s[k] / 0.1F, 1e-6F);
    }
  }
  EXPECT_EQ(points, summary.points);
  EXPECT_EQ(rows("times.txt"), (std::vector<std::vector<double>>{{0}, {0.1}, {0.2}}));
  EXPECT_EQ(text("poses.txt"), text("poses_end.txt"));
  const auto poses = rows("poses_mid.txt");
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0], (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
  const Eigen::Matrix4d last = drive.sweep(2).T_odom_lidar_mid.matrix();
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR(poses[2][k], last(static_cast<int>(k / 4), static_cast<int>(k % 4)), 1e-11);
  }
  EXPECT_THAT(text("calib.txt"), HasSubstr("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n"));
  EXPECT_THAT(text("meta.json"), HasSubstr("\"deskewed\": false"));
  EXPECT_THAT(text("meta.json"), HasSubstr("\"rate_hz\": 10,"));
  EXPECT_THAT(text("meta.json"), HasSubstr("\"frames\": 3,"));
  EXPECT_NEAR(summary.path_m, drive.path().distance_m(7.25) - drive.path().distance_m(7.05), 0.03);
}

TEST_F(DriveWriterTest, DeskewedDriveHasNoTimesAndReplacesALongerOne) {
  write_drive(DriveSimulator(config(4, false)), folder_);
  write_drive(DriveSimulator(config(2, true)), folder_);
  EXPECT_FALSE(fs::exists(folder_ / "times_pt"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "velodyne"), fs::directory_iterator()), 2);
  EXPECT_EQ(text("poses.txt"), text("poses_mid.txt"));
  EXPECT_EQ(rows("poses.txt").size(), 2U);
  EXPECT_THAT(text("meta.json"), HasSubstr("\"deskewed\": true"));
}

TEST_F(DriveWriterTest, StoppedDriveIsAShorterOne) {
  std::vector<std::size_t> seen;
  const DriveSummary summary =
      write_drive(DriveSimulator(config(5, false)), folder_, [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(total, 5U);
        EXPECT_FALSE(fs::exists(folder_ / "meta.json"));  // not finished yet
        seen.push_back(done);
        return done < 2;
      });
  EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(summary.sweeps, 2U);
  EXPECT_EQ(rows("times.txt").size(), 2U);
  EXPECT_EQ(rows("poses_start.txt").size(), 2U);
  EXPECT_THAT(text("meta.json"), HasSubstr("\"frames\": 2,"));
}

TEST_F(DriveWriterTest, LeavesOtherPeoplesFilesAlone) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "thesis.tex") << "years of work";
  std::ofstream(folder_ / "times.txt") << "0\n";
  try {
    write_drive(DriveSimulator(config(1, false)), folder_);
    FAIL() << "wrote over a foreign folder";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("thesis.tex"));
  }
  EXPECT_EQ(text("thesis.tex"), "years of work");
  EXPECT_EQ(text("times.txt"), "0\n");
}

TEST_F(DriveWriterTest, LeavesADriveOfAnotherSensorAlone) {
  fs::create_directories(folder_ / "velodyne");
  for (const char* name : {"velodyne/000000.bin", "times.txt", "calib.txt"}) std::ofstream(folder_ / name) << "real";
  for (const char* meta : {"", "{\"generator\": \"another\", \"rate_hz\": 10}"}) {
    if (*meta != 0) std::ofstream(folder_ / "meta.json") << meta;
    try {
      write_drive(DriveSimulator(config(1, false)), folder_);
      FAIL() << "wrote over a foreign drive";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("choose an empty folder"));
    }
    for (const char* name : {"velodyne/000000.bin", "times.txt", "calib.txt"}) EXPECT_EQ(text(name), "real");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), *meta != 0 ? 4 : 3);
  }
}

TEST_F(DriveWriterTest, TakesAwayWhatAKilledOneLeftButNotALock) {
  fs::create_directories(folder_ / "velodyne");
  std::ofstream(folder_ / "meta.partial.json") << R"({"generator": "rilo simulate"})";
  std::ofstream(folder_ / "velodyne" / ".000007.bin.6732-8.tmp") << "half";
  std::ofstream(folder_ / ".poses.txt.6732-27.tmp") << "half";
  std::ofstream(folder_ / ".rilo.lock") << "held";
  write_drive(DriveSimulator(config(1, true)), folder_);
  EXPECT_FALSE(fs::exists(folder_ / ".poses.txt.6732-27.tmp"));
  EXPECT_FALSE(fs::exists(folder_ / "meta.partial.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "velodyne"), fs::directory_iterator()), 1);
  EXPECT_EQ(text(".rilo.lock"), "held");
}

TEST_F(DriveWriterTest, SaysWhereItCannotWrite) {
  std::ofstream(root_ / "file") << "no folder";
  try {
    write_drive(DriveSimulator(config(1, false)), root_ / "file" / "drive");
    FAIL() << "wrote into a file";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr((root_ / "file" / "drive").string()));
    EXPECT_THAT(error.what(), HasSubstr("Not a directory"));
  }
}

}  // namespace
}  // namespace rilo
