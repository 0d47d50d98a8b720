// The folder of a run, read back.
#include "results/saved_run.hpp"

#include <unistd.h>

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "results/metrics_json.hpp"
#include "results/output_check.hpp"
#include "results/pose_files.hpp"
#include "results/run_metrics.hpp"
#include "results/run_outputs.hpp"

namespace rilo::test {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

RunRecord straight_run() {
  RunRecord run;
  run.data = "drive";
  run.source.kind = "folder";
  run.source.format = "bin";
  for (std::size_t i = 0; i < 5; ++i) {
    SweepResult result;
    result.stamp_ns = static_cast<std::int64_t>(i) * 100'000'000;
    result.T_odom_lidar.translation().x() = 0.5 * static_cast<double>(i);
    run.results.push_back(result);
    run.indices.push_back(i + 2);
  }
  return run;
}

void write_run(const TempDir& folder, const RunMetrics& metrics) {
  OutputRequest request;
  request.out = folder.path();
  write_outputs(request, straight_run(), metrics);
}

std::string refusal(const std::filesystem::path& folder) {
  try {
    read_saved_run(folder);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(SavedRun, IsWhatWasWritten) {
  const TempDir folder;
  const RunRecord run = straight_run();
  write_run(folder, run_metrics(run));
  ASSERT_TRUE(is_saved_run(folder.path()));
  const SavedRun saved = read_saved_run(folder.path());
  EXPECT_EQ(to_json(saved.metrics), to_json(run_metrics(run)));
  EXPECT_EQ(saved.record.indices, run.indices);
  EXPECT_EQ(saved.record.source.kind, "folder");
  EXPECT_DOUBLE_EQ(saved.record.source.period_s, 0.1);
  ASSERT_EQ(saved.record.results.size(), 5U);
  EXPECT_EQ(saved.record.results[3].T_odom_lidar.translation().x(), 1.5);
  EXPECT_NEAR(saved.record.results[3].twist[3], 5.0, 1e-9);  // from the poses beside it
}

TEST(SavedRun, KnowsItsPeriodHowItEndedAndTheCalibrationOfItsData) {
  const TempDir folder;
  folder.write("drive/calib.txt", "Tr: 1 0 0 0.5 0 1 0 0 0 0 1 0\n");
  RunRecord run = straight_run();
  run.data = folder / "drive";
  run.signal = 2;
  for (std::size_t i = 0; i < 5; ++i) run.results[i].stamp_ns = static_cast<std::int64_t>(i) * 50'000'000;
  run.results[4].stamp_ns = run.results[3].stamp_ns;
  OutputRequest request;
  request.out = folder / "out";
  std::filesystem::create_directory(request.out);
  write_outputs(request, run, run_metrics(run));
  const SavedRun saved = read_saved_run(request.out);
  EXPECT_NE(saved.record.signal, 0);
  EXPECT_DOUBLE_EQ(saved.record.source.period_s, 0.05);
  EXPECT_EQ(saved.record.source.T_cam_lidar.value().translation().x(), 0.5);
  EXPECT_NEAR(saved.record.results[1].twist[3], 10.0, 1e-9);
  EXPECT_EQ(saved.record.results[4].twist, Vector6d::Zero());  // no time went by
  std::ofstream(folder / "out" / "poses_lidar.txt", std::ios::app) << "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_THAT(refusal(request.out), HasSubstr("6 poses"));
}

TEST(SavedRun, FindsTheDataFromAnotherFolder) {
  const TempDir folder;
  const auto write = [&](const std::string& data_path) {
    RunMetrics metrics = run_metrics(straight_run());
    metrics.data_path = data_path;
    write_run(folder, metrics);
  };
  write(folder / "gone");
  EXPECT_EQ(read_saved_run(folder.path()).record.data, "drive");  // as typed
  folder.write("drive/times.txt", "0");
  write(folder / "drive");
  EXPECT_EQ(read_saved_run(folder.path()).record.data, folder / "drive");
}

TEST(SavedRun, OfSeveralCloudsTheMapIsTheOneNamedSo) {
  const TempDir folder;
  write_run(folder, run_metrics(straight_run()));
  const auto ply = [](int points) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) +
                       "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (int i = 0; i < points; ++i) text += std::to_string(i) + " 0 0\n";
    return text;
  };
  folder.write("first.ply", ply(7));
  EXPECT_EQ(read_saved_run(folder.path()).record.map.points.size(), 7U);
  folder.write("second.ply", ply(1));
  EXPECT_TRUE(read_saved_run(folder.path()).record.map.points.empty());
  folder.write("map.ply", ply(2));
  EXPECT_EQ(read_saved_run(folder.path()).record.map.points.size(), 2U);
}

TEST(SavedRun, IsReadWithoutWhatIsDamagedBesideIt) {
  const TempDir folder;
  folder.write("drive/calib.txt", "Tr: 1 2\n");
  RunMetrics metrics = run_metrics(straight_run());
  metrics.data_path = folder / "drive";
  write_run(folder, metrics);
  folder.write("map.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  const SavedRun saved = read_saved_run(folder.path());
  EXPECT_EQ(saved.record.results.size(), 5U);
  EXPECT_THAT(saved.notices, UnorderedElementsAre(HasSubstr("map.ply"), HasSubstr("calib.txt")));
}

TEST(SavedRun, SaysWhatIsMissing) {
  const TempDir folder;
  EXPECT_THAT(refusal(folder / "nowhere"), HasSubstr("no such folder"));
  EXPECT_THAT(refusal(folder.write("file", "")), HasSubstr("a file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("neither metrics.json nor"));
}

TEST(SavedRun, NumbersOutOfRangeAreNamedWithTheirFile) {
  const TempDir folder;
  const auto file = folder.write("metrics.json", R"({"frames": 1e999})");
  expect_io_error([&] { read_json_object(file, "metrics.json of rilo run", "Run rilo run again"); },
                  {"metrics.json", "1e999", "Run rilo run again"});
}

TEST(Outputs, AFileThatCannotBeReadIsNotReplaced) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TempDir folder;
  const std::filesystem::path file = folder.write("map.ply", "mine");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_THROW(check_replaced(file, "Rilo map", "map of an earlier run", "--map"), RunError);
}

// Longer than a file system takes, so that looking at it fails, too.
TEST(Paths, ThatCannotBeLookedAtAreRefusedAsSuch) {
  const TempDir folder;
  const std::filesystem::path name = folder / std::string(300, 'n');
  EXPECT_THROW(read_poses(name), IoError);
  EXPECT_THROW(read_truth(name, PoseInstant::kMid), IoError);
  try {
    create_folder(name);
    FAIL() << "created";
  } catch (const RunError& error) {
    EXPECT_EQ(error.kind(), RunErrorKind::kCannotWrite);
    EXPECT_THAT(error.what(), HasSubstr("choose another --out"));
  }
}

}  // namespace
}  // namespace rilo::test
