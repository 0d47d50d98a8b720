// KITTI's sweeps, raw and compensated, from ../shared/data; tests are skipped where it is absent.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "io/io_test_util.hpp"
#include "rilo/io/scan_source.hpp"
#include "session/compensation_trial.hpp"
#include "shared_folder.hpp"

namespace rilo::test {
namespace {

/// Of the sweeps in `name`.tar.xz.
CompensationTrial trial_of_archive(const std::string& name, const std::filesystem::path& archive) {
  const TempDir folder;
  const std::string command = "tar -xJf '" + archive.string() + "' -C '" + folder.path().string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return try_compensation([&] { return open_scan_source(folder / name); }, 0, {}, {});
}

std::filesystem::path archive_of(const std::string& name) { return shared_folder() / "data" / (name + ".tar.xz"); }

TEST(RealTrial, KittiOdometryIsCompensated) {
  const std::filesystem::path archive = archive_of("kitti00_16");
  if (!std::filesystem::exists(archive)) GTEST_SKIP() << "no " << archive;
  const CompensationTrial trial = trial_of_archive("kitti00_16", archive);
  EXPECT_GE(trial.sweeps, 10U);
  EXPECT_GE(trial.better, trial.sweeps / 2) << "the fit alone would say raw";
  EXPECT_TRUE(trial.compensated());
}

TEST(RealTrial, KittiRawIsRaw) {
  const std::filesystem::path archive = archive_of("kitti_raw_0001");
  if (!std::filesystem::exists(archive)) GTEST_SKIP() << "no " << archive;
  const CompensationTrial trial = trial_of_archive("kitti_raw_0001", archive);
  EXPECT_EQ(trial.times, PointTimes::kAzimuth);
  EXPECT_EQ(trial.on_cones, trial.sweeps);
  EXPECT_TRUE(trial.raw());
}

}  // namespace
}  // namespace rilo::test
