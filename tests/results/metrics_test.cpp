// Figures of a run as JSON and back.
#include <gmock/gmock.h>

#include "results/evaluation_output.hpp"
#include "results/metrics_json.hpp"
#include "results/run_metrics.hpp"
#include "results/run_report.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

RunRecord short_run() {
  RunRecord run;
  run.command_line = "rilo run drive";
  run.data = "drive";
  run.threads = 2;
  for (const double ms : {10.0, 20.0, 30.0, 50.0}) {
    SweepResult result;
    result.status = OdometryStatus::kOk;
    result.stats.times.total_ms = ms;
    result.stats.times.map_ms = ms / 4;
    result.stats.iterations = 3;
    run.results.push_back(result);
  }
  run.results.back().stats.elevation_offset_rad = 0.0035;
  run.results.back().stats.elevation_offset_sigma_rad = 0.0005;
  run.results.back().stats.elevation_applied_rad = 0.0035;
  return run;
}

TEST(Metrics, OfARun) {
  const RunMetrics metrics = run_metrics(short_run());
  EXPECT_EQ(metrics.frames, 4U);
  EXPECT_EQ(metrics.ms.mean, 27.5);
  EXPECT_EQ(metrics.ms.median, 25.0);
  EXPECT_DOUBLE_EQ(metrics.ms.p95.value(), 47.0);  // 30 + 0.85 · 20
  EXPECT_EQ(metrics.ms.max, 50.0);
  EXPECT_DOUBLE_EQ(metrics.stage_mean_ms.map, 6.875);
  EXPECT_EQ(metrics.status.at("ok"), 4U);
  EXPECT_EQ(metrics.status.at("lost"), 0U);
  EXPECT_TRUE(std::filesystem::path(metrics.data_path).is_absolute());
  EXPECT_FALSE(metrics.evaluated());
}

TEST(Metrics, CausesOfLossesAreCounted) {
  RunRecord run = short_run();
  EXPECT_TRUE(run_metrics(run).loss_causes.empty());
  run.results[1].status = OdometryStatus::kLost;
  run.results[1].stats.loss_cause = LossCause::kLowScore;
  run.results[2].status = OdometryStatus::kInitialising;  // the map is given up
  run.results[2].stats.loss_cause = LossCause::kLowScore;
  run.results[3].status = OdometryStatus::kLost;
  run.results[3].stats.loss_cause = LossCause::kCovered;
  EXPECT_EQ(run_metrics(run).loss_causes, (Counts{{"covered", 1}, {"low_score", 2}}));
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("\nlost because    covered 1 low_score 2\n"));
}

TEST(Metrics, OfEverySweepAndOfTheLast) {
  RunRecord run = short_run();
  run.signal = 2;
  run.results[1].stats.coarse_ran = true;
  run.results[2].stats.coarse_ran = true;
  run.results[0].stats.over_budget = true;
  run.results.back().stats.elevation_applied_rad = 0.001;
  run.results.back().stats.beam_elevation_rms_rad = 0.002;
  run.results.back().stats.beam_azimuth_rms_rad = 0.003;
  RunMetrics metrics = run_metrics(run);
  EXPECT_TRUE(metrics.interrupted);
  EXPECT_EQ(metrics.mean_iterations, 3);
  EXPECT_EQ(metrics.coarse_runs, 2U);
  EXPECT_FALSE(metrics.budget);
  EXPECT_NEAR(metrics.elevation_offset_deg.value(), 0.2005, 1e-4);
  EXPECT_NEAR(metrics.elevation_offset_applied_deg.value(), 0.0573, 1e-4);
  EXPECT_NEAR(metrics.beam_elevation_rms_deg, 0.1146, 1e-4);
  EXPECT_NEAR(metrics.beam_azimuth_rms_deg, 0.1719, 1e-4);
  run.config.elevation.enabled = false;
  run.config.budget.sweep_ms = 50;
  metrics = run_metrics(run);
  EXPECT_FALSE(metrics.elevation_offset_deg);
  EXPECT_EQ(metrics.budget->over_budget, 1U);
}

TEST(Metrics, CompensationNeedsTimesAndIsTriedWithoutThem) {
  RunRecord run = short_run();
  EXPECT_FALSE(run_metrics(run).motion_compensation);
  EXPECT_FALSE(run_metrics(run).compensation);
  run.trial = {PointTimes::kOrder, 10, 6, 3, 1, 0};
  EXPECT_EQ(run_metrics(run).compensation, (TrialMetrics{"order", 10, 6, 3, 1, 0, true, false}));
  run.trial.times = PointTimes::kAuto;
  EXPECT_FALSE(run_metrics(run).compensation);
  run.source.has_point_times = true;
  EXPECT_TRUE(run_metrics(run).motion_compensation);
  run.config.preprocess.deskew = false;
  EXPECT_FALSE(run_metrics(run).motion_compensation);
}

TEST(Metrics, EveryErrorAtItsPlace) {
  const auto summary_of = [](double rmse) {
    ErrorSummary summary;
    summary.count = 1;
    summary.rmse = rmse;
    return summary;
  };
  Evaluation e;
  e.path_m = 9.5;
  e.end_error_pct = 3;
  e.kitti.short_path = true;
  e.kitti.segments = {{0, 1, 5, 0.02, 0}};
  e.ape = {Alignment::kUmeyama, SE3::Identity(), summary_of(1), summary_of(2)};
  e.ape_unaligned = {Alignment::kFirstPose, SE3::Identity(), summary_of(3), summary_of(4)};
  e.rpe_frame = {summary_of(5), summary_of(6)};
  e.rpe_metre = {summary_of(7), summary_of(8)};
  const EvaluationMetrics metrics = evaluation_metrics(e);
  EXPECT_EQ(metrics.ape_m.rmse, 1);
  EXPECT_EQ(metrics.ape_rotation_deg.rmse, 2);
  EXPECT_EQ(metrics.ape_unaligned_m.rmse, 3);
  EXPECT_EQ(metrics.ape_unaligned_rotation_deg.rmse, 4);
  EXPECT_EQ(metrics.rpe_frame_m.rmse, 5);
  EXPECT_EQ(metrics.rpe_frame_deg.rmse, 6);
  EXPECT_EQ(metrics.rpe_metre_m_per_m.rmse, 7);
  EXPECT_EQ(metrics.rpe_metre_deg_per_m.rmse, 8);
  EXPECT_EQ(metrics.end_error_pct, 3);
  EXPECT_THAT(metrics.t_rel_protocol, HasSubstr("eighths"));
  // Below 10 m a summary says no percentage of the path.
  RunRecord run = short_run();
  run.truth.emplace();
  for (const auto& [path_m, said] : {std::pair(9.5, false), {10.0, true}}) {
    e.path_m = path_m;
    run.evaluation = e;
    EXPECT_EQ(run_summary(run_metrics(run)).find("t_rel 2.0000 %") != std::string::npos, said);
  }
}

TEST(Metrics, AReportLaysTheTrueBeginningOntoTheEstimates) {
  RunRecord run = short_run();
  run.source.period_s = 0.05;
  run.truth.emplace();
  run.truth->truth.assign(2, SE3::Identity());
  run.truth->truth[0].translation().x() = 10;
  run.truth->truth[1].translation().x() = 12;
  run.truth->estimate.assign(2, SE3::Identity());
  run.truth->estimate[0].translation().y() = 5;
  const RunReport report = report_of(run, run_metrics(run));
  ASSERT_EQ(report.truth.size(), 2U);
  EXPECT_EQ(report.truth[1].translation(), Eigen::Vector3d(2, 5, 0));
  EXPECT_DOUBLE_EQ(report.sweep_period_ms, 50);
}

TEST(Metrics, JsonIsReadBackWithoutLoss) {
  RunMetrics metrics = run_metrics(short_run());
  metrics.evaluation.t_rel_pct = 1.0 / 3;
  metrics.evaluation.ape_m = {0.1, 0.2, 0.3, 0.4, 0.5};
  metrics.evaluation.truth = "poses.txt";
  metrics.budget = BudgetMetrics{50, 1, 2, 3};
  metrics.warnings = {"a", "b"};
  metrics.stamp_faults.gaps = 2;
  metrics.repeats = 3;
  const json first = to_json(metrics);
  EXPECT_EQ(first["t_rel_pct"], 1.0 / 3);
  EXPECT_EQ(first["ape_rmse_m"], 0.1);
  EXPECT_TRUE(first["r_rel_deg_per_100m"].is_null());
  EXPECT_TRUE(first["started_over_after_sweeps"].is_null());
  EXPECT_FALSE(first.contains("error"));
  EXPECT_EQ(to_json(metrics_of(first, "metrics.json")), first);
}

TEST(Metrics, WithoutSweeps) {
  RunRecord run;
  run.data = "drive";
  const json metrics = to_json(run_metrics(run));
  EXPECT_TRUE(metrics["ms"].is_null());
  EXPECT_EQ(metrics["frames"], 0);
}

TEST(Metrics, OfAPeerOnlyWhatIsKnown) {
  RunMetrics metrics;
  metrics.evaluation.t_rel_pct = 0.5;
  EXPECT_EQ(to_json(metrics, MetricKeys::kSparse), (json{{"evaluation", {{"t_rel_pct", 0.5}}}}));
}

TEST(Metrics, AValueOfAnotherTypeIsRefusedWithItsKey) {
  try {
    metrics_of(json{{"evaluation", {{"ape_m", {{"rmse", "small"}}}}}}, "metrics.json");
    FAIL() << "accepted";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("key evaluation/ape_m/rmse"));
    EXPECT_THAT(error.what(), HasSubstr("string"));
    EXPECT_THAT(error.what(), HasSubstr("number"));
  }
  EXPECT_THROW(metrics_of(json{{"status", {{"ok", "many"}}}}, "m"), IoError);
  EXPECT_THROW(metrics_of(json{{"warnings", "one"}}, "m"), IoError);
  EXPECT_NO_THROW(metrics_of(json{{"of a later version", 1}, {"threads", nullptr}}, "m"));
}

TEST(Metrics, TheSummaryNamesOneElevationOffset) {
  RunRecord run = short_run();
  const std::string text = run_summary(run_metrics(run));
  EXPECT_THAT(text, HasSubstr("estimated +0.201 ± 0.029 deg, applied +0.201 deg"));
  EXPECT_THAT(text, Not(HasSubstr("--elevation-correction")));
  EXPECT_THAT(text, HasSubstr("median 25.0"));
  run.source.elevation_correction_deg = 0.205;
  run.restart = Restart{.after_sweeps = 18, .elevation_offset_deg = 0.197};
  const std::string corrected = run_summary(run_metrics(run));
  EXPECT_THAT(corrected, HasSubstr("given +0.205 deg (--elevation-correction)"));
  EXPECT_THAT(corrected, HasSubstr("applied +0.201 deg at last, +0.197 deg from the first sweep on\n"));
  EXPECT_THAT(corrected, HasSubstr("passes          2: restarted after 18 sweeps with what they say\n"));
  run.restart->elevation_offset_deg = 0;
  EXPECT_THAT(run_summary(run_metrics(run)), Not(HasSubstr("at last")));
}

TEST(Metrics, TheSummaryAddsUpTheAnglesThatWereGiven) {
  RunRecord run = short_run();
  run.source.elevation_correction_deg = 0.2;
  run.elevation_given_deg = 0.1;
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("given +0.200 deg (--elevation-correction) and +0.100 deg "
                                                       "to begin with, +0.300 deg together"));
  run.source.elevation_correction_deg = 0;
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("elevation given +0.100 deg to begin with\n"));
  run.restart = Restart{.after_sweeps = 18, .elevation_offset_deg = 0.1};  // because of the beams
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("elevation given +0.100 deg to begin with\n"));
  run.config.elevation.enabled = false;  // nothing is estimated; what is given is applied all the same
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("elevation given +0.100 deg to begin with\n"));
}

TEST(Metrics, TheCalibrationThatARunBeganWithIsNamed) {
  RunRecord run = short_run();
  EXPECT_FALSE(to_json(run_metrics(run)).contains("calibration"));
  EXPECT_THAT(run_summary(run_metrics(run)), Not(HasSubstr("calibration  ")));
  run.calibration = "other/calibration.yaml";  // its offset may be 0: the beams count, too
  const json metrics = to_json(run_metrics(run));
  EXPECT_EQ(metrics["calibration"], "other/calibration.yaml");
  EXPECT_EQ(to_json(metrics_of(metrics, "metrics.json")), metrics);
  EXPECT_THAT(run_summary(run_metrics(run)), HasSubstr("\ncalibration     other/calibration.yaml\n"));
}

TEST(Metrics, AFigureWithoutAnErrorBehindItIsNone) {
  const std::vector<SE3> standing(3, SE3::Identity());
  const json metrics = to_json(evaluation_metrics(evaluate(standing, standing)));
  EXPECT_TRUE(metrics["rpe_metre_m_per_m"]["rmse"].is_null()) << metrics;
  EXPECT_TRUE(metrics["end_error_pct"].is_null());
  EXPECT_EQ(metrics["end_error_m"], 0.0);
  EXPECT_EQ(metrics["rpe_frame_m"]["rmse"], 0.0);
  const std::string text = evaluation_table(evaluate(standing, standing));
  EXPECT_THAT(text, HasSubstr("RPE per metre                      none"));
  EXPECT_THAT(text, Not(HasSubstr("% of the path")));
}

TEST(Metrics, FlakesAreNamedWhereThereWereSome) {
  RunRecord run = short_run();
  EXPECT_FALSE(run_metrics(run).flake_sweeps);
  EXPECT_THAT(run_summary(run_metrics(run)), Not(HasSubstr("flakes")));
  for (SweepResult& result : run.results) {
    result.stats.points_valid = 100;
  }
  run.results[1].stats.points_isolated = 200;
  run.results[2].stats.points_isolated = 400;
  const RunMetrics metrics = run_metrics(run);
  EXPECT_EQ(metrics.flake_sweeps, 2U);
  EXPECT_EQ(metrics.flakes_pct, 75);
  EXPECT_EQ(to_json(metrics_of(to_json(metrics), "metrics.json")), to_json(metrics));
  EXPECT_THAT(run_summary(metrics), HasSubstr("\nflakes          75 % of the returns dropped, in 2 sweeps"));
}

}  // namespace
}  // namespace rilo
