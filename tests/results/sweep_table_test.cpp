// sweeps.csv: what is written is read back.
#include "results/sweep_table.hpp"

#include <gmock/gmock.h>

#include "io/io_test_util.hpp"
#include "results/csv_file.hpp"

namespace rilo::test {
namespace {

using testing::HasSubstr;

SweepResult some_result() {
  SweepResult r;
  r.stamp_ns = 1'317'042'145'964'000'001;
  r.status = OdometryStatus::kDegenerate;
  r.twist << 0.1, 0.2, 0.2, 1, 2, 2;
  r.covariance.diagonal() << 0.25, 1, 4, 9, 16, 25;
  SweepStats& s = r.stats;
  s.points_in = 1;
  s.points_valid = 2;
  s.points_isolated = 9;
  s.points_map = 3;
  s.points_source = 4;
  s.map_voxels = 5;
  s.initial_pose = InitialPoseSource::kCoarse;
  s.initial_pose_reason = InitialPoseReason::kNoTime;
  s.coarse_ran = true;
  s.coarse_iterations = 6;
  s.pred_align_distance_m = 0.1;
  s.prediction_score = 1.0 / 3;
  s.map_score = 0.3;
  s.iterations = 7;
  s.converged = true;
  s.inliers = 8;
  s.inlier_ratio = 0.4;
  s.residual_rms_m = 1e-300;
  s.sigma_th_m = 0.5;
  s.gamma = 0.6;
  s.deviation_m = 0.7;
  s.relative_eigenvalues = {0.01, 0.02, 0.03, 0.04, 0.05, 1};
  s.elevation_offset_rad = -0.001;
  s.elevation_applied_rad = 0.002;
  s.beam_elevation_rms_rad = 0.003;
  s.beam_azimuth_rms_rad = 0.004;
  s.loss_cause = LossCause::kImpossibleMotion;
  s.impossible_motion = s.points_cut = s.over_budget = true;
  s.times = {1.5, 2.5, 3.5, 4.5, 12.0};
  return r;
}

std::string csv() { return sweeps_csv({some_result(), SweepResult{}}, {3, 5}); }

TEST(SweepTable, SaysSpeedAndTurnRate) {
  const TempDir folder;
  CsvFile line(folder.write("sweeps.csv", csv()), {"", "", ""});
  ASSERT_TRUE(line.next());
  EXPECT_DOUBLE_EQ(line.number<double>("speed_m_s"), 3);
  EXPECT_DOUBLE_EQ(line.number<double>("turn_rate_rad_s"), 0.3);
  EXPECT_DOUBLE_EQ(line.number<double>("sigma_pitch_rad"), 1);
  EXPECT_DOUBLE_EQ(line.number<double>("sigma_z_m"), 5);
}

TEST(SweepTable, IsReadBackWithoutLoss) {
  const TempDir folder;
  const SweepTable table = read_sweeps_csv(folder.write("sweeps.csv", csv()));
  ASSERT_EQ(table.results.size(), 2U);
  EXPECT_EQ(table.indices, (std::vector<std::size_t>{3, 5}));
  const SweepResult& r = table.results[0];
  EXPECT_EQ(r.stamp_ns, some_result().stamp_ns);
  EXPECT_EQ(r.covariance, some_result().covariance);
  EXPECT_EQ(r.stats.initial_pose_reason, InitialPoseReason::kNoTime);
  EXPECT_EQ(r.stats.prediction_score, 1.0 / 3);
  EXPECT_EQ(r.stats.loss_cause, LossCause::kImpossibleMotion);
  // Velocities are not in the file, only their norms; with them put back every column is as before.
  SweepResult again = r;
  again.twist = some_result().twist;
  EXPECT_EQ(sweeps_csv({again, SweepResult{}}, {3, 5}), csv());
}

TEST(SweepTable, LinesMayEndAsOnWindows) {
  std::string text;
  for (const char c : csv()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const TempDir folder;
  SweepTable table = read_sweeps_csv(folder.write("sweeps.csv", text));
  ASSERT_EQ(table.results.size(), 2U);
  table.results[0].twist = some_result().twist;  // not in the file
  EXPECT_EQ(sweeps_csv(table.results, table.indices), csv());
  EXPECT_EQ(table.results.at(0).stats.times.total_ms, 12.0);
}

TEST(SweepTable, MayBeginWithAByteOrderMark) {
  const TempDir folder;
  EXPECT_EQ(read_sweeps_csv(folder.write("sweeps.csv", "\xEF\xBB\xBF" + csv())).results.size(), 2U);
}

TEST(SweepTable, ColumnsThatAreNotNeededMayBeMissing) {
  const TempDir folder;
  const std::string header =
      "sweep,stamp_ns,status,initial_pose,iterations,inlier_ratio,sigma_th_m,preprocess_ms,initial_pose_ms,"
      "registration_ms,map_ms,total_ms,later\n";
  const SweepTable table = read_sweeps_csv(folder.write("a.csv", header + "0,1,ok,coarse,2,0.5,0.25,1,2,3,4,10,x\n"));
  EXPECT_EQ(table.results.at(0).stats.initial_pose, InitialPoseSource::kCoarse);
  EXPECT_EQ(table.results.at(0).stats.map_voxels, 0U);
}

void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
  const TempDir folder;
  try {
    read_sweeps_csv(folder.write("sweeps.csv", text));
    FAIL() << "accepted: " << text;
  } catch (const IoError& error) {
    for (const std::string& part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
  }
}

TEST(SweepTable, RefusesWhatDoesNotFitWithItsPlace) {
  std::string bad_status = csv();
  bad_status.replace(bad_status.find("degenerate"), 10, "fine");
  expect_refused(bad_status, {"sweeps.csv", "line 2, column status", "fine"});
  expect_refused("sweep,stamp_ns\n0,1\n", {"line 1", "no column status"});
  expect_refused(csv().substr(0, csv().size() - 8), {"line 3"});
  expect_refused("", {"sweeps.csv"});
}

}  // namespace
}  // namespace rilo::test
