// Tables, averages and results.json of cells made by hand.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/cell_file.hpp"
#include "bench/saved_results.hpp"
#include "bench/tables.hpp"
#include "io/io_test_util.hpp"
#include "results/metrics_json.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using test::TempDir;
using testing::HasSubstr;
using testing::Not;

constexpr double kPi = 3.14159265358979323846;

// A cell whose segments all have that error.
BenchCell cell(const std::string& sequence, const std::string& configuration, double t_rel_pct, std::size_t segments) {
  BenchCell made;
  made.sequence = sequence;
  made.configuration = configuration;
  made.kitti = KittiError{};
  const double r_err = 2 * t_rel_pct / 100 * kPi / 180;  // 2 °/100 m for 1 %
  made.kitti->segments.assign(segments, KittiSegment{0, 1, 100, t_rel_pct / 100, r_err});
  made.metrics = metrics_of({{"frames", 12},
                             {"ms", {{"mean", 10.0}, {"median", 9.0}, {"p95", 15.0}, {"p99", 18.0}, {"max", 20.0}}},
                             {"mean_iterations", 4.5},
                             {"selection_rate_pct", 25.0},
                             {"coarse_rate_pct", 50.0},
                             {"peak_rss_mb", 31.4},
                             {"pose_instant", "mid"},
                             {"elevation_correction_deg", 0.0},
                             {"elevation_offset_applied_deg", 0.125},
                             {"status", {{"ok", 11}, {"lost", 0}, {"initialising", 1}}},
                             {"evaluation",
                              {{"poses", 12},
                               {"t_rel_pct", t_rel_pct},
                               {"r_rel_deg_per_100m", 2 * t_rel_pct},
                               {"truth_instant", "mid"},
                               {"ape_m", {{"rmse", 0.5}, {"mean", 0.4}, {"std", 0.3}}},
                               {"ape_unaligned_m", {{"rmse", 0.75}}},
                               {"rpe_frame_m", {{"rmse", 0.01}}},
                               {"rpe_frame_deg", {{"rmse", 0.02}}}}}},
                            "test");
  return made;
}

BenchCell failed(const std::string& sequence, const std::string& configuration) {
  BenchCell made;
  made.sequence = sequence;
  made.configuration = configuration;
  made.error = "there is nothing of this name";
  made.error_code = kBadData;
  return made;
}

const TitledTable& titled(const std::vector<TitledTable>& tables, const std::string& title) {
  for (const TitledTable& table : tables) {
    if (table.title == title) return table;
  }
  throw std::runtime_error("no table " + title);
}

TEST(BenchTables, PooledAverageWeighsBySegmentsTheOtherBySequences) {
  // 1 % on 30 segments, 3 % on 10: pooled 1.5, mean of the sequences 2.
  const auto all = summaries({cell("a", "x", 1, 30), cell("b", "x", 3, 10)});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].cells, 2U);
  EXPECT_NEAR(all[0].kitti.pooled_t_rel_pct.value(), 1.5, 1e-12);
  EXPECT_NEAR(all[0].kitti.pooled_r_rel_deg_100m.value(), 3.0, 1e-12);
  EXPECT_NEAR(all[0].means.at(0).value(), 2.0, 1e-12);
}

TEST(BenchTables, EveryFigureOfTheIssueIsThere) {
  const auto tables = bench_tables({cell("a", "x", 1, 30), cell("a", "y", 3, 30)});
  const TextTable& accuracy = titled(tables, "Accuracy").table;
  EXPECT_EQ(accuracy.header, (std::vector<std::string>{"sequence", "configuration", "poses", "t_rel %", "r_rel °/100m",
                                                       "APE rmse m", "APE mean m", "unaligned rmse m", "RPE m",
                                                       "instant", "truth at", "given °", "own °"}));
  EXPECT_EQ(accuracy.rows.at(0), (std::vector<std::string>{"a", "x", "12", "1.0000", "2.0000", "0.5000", "0.4000",
                                                           "0.7500", "0.0100", "mid", "mid", "0.0", "0.125"}));
  const TextTable& effort = titled(tables, "Effort").table;
  EXPECT_EQ(effort.header,
            (std::vector<std::string>{"sequence", "configuration", "sweeps", "ms mean", "median", "p95", "p99", "max",
                                      "iterations", "selected %", "coarse %", "peak MiB", "status"}));
  EXPECT_EQ(effort.rows.at(0), (std::vector<std::string>{"a", "x", "12", "10.0", "9.0", "15.0", "18.0", "20.0", "4.50",
                                                         "25.00", "50.00", "31", "initialising 1, ok 11"}));
  EXPECT_EQ(titled(tables, "t_rel % of each sequence").table.plain(),
            "sequence       x       y\n"
            "a         1.0000  3.0000\n");
}

TEST(BenchTables, AFailedCellIsListedAndCountsInNoAverage) {
  const auto tables = bench_tables({cell("a", "x", 1, 30), failed("b", "x")});
  const TitledTable& averages = titled(tables, "Averages of the configurations");
  EXPECT_EQ(averages.table.rows.at(0).at(1), "1 of 2");
  EXPECT_EQ(averages.table.rows.at(0).at(2), "1.0000");
  EXPECT_THAT(averages.note, HasSubstr("failed: b × x: there is nothing of this name"));
  EXPECT_THAT(plain_text(tables), HasSubstr("failed: b × x"));
  EXPECT_THAT(markdown_text(tables), HasSubstr("\n\nfailed: b × x"));
  const TextTable csv = bench_csv({failed("b", "x")});
  EXPECT_EQ(csv.rows.at(0).back(), "there is nothing of this name");
  EXPECT_EQ(csv.rows.at(0).size(), csv.header.size());
}

TEST(BenchTables, APeerHasNoTimesAndARowOfItsOwn) {
  BenchCell peer = cell("a", "KISS", 2, 30);
  peer.peer = true;
  const EvaluationMetrics evaluation = peer.metrics.evaluation;
  peer.metrics = {};
  peer.metrics.evaluation = evaluation;
  const auto tables = bench_tables({cell("a", "x", 1, 30), peer});
  EXPECT_EQ(titled(tables, "Accuracy").table.rows.size(), 2U);
  EXPECT_EQ(titled(tables, "Effort").table.rows.size(), 1U);
  EXPECT_FALSE(value_of(peer, bench_figure("ms_mean")).has_value());
  EXPECT_EQ(titled(tables, "t_rel % of each sequence").table.rows.at(0),
            (std::vector<std::string>{"a", "1.0000", "2.0000"}));
}

TEST(BenchTables, WithoutCells) {
  const auto tables = bench_tables({});
  EXPECT_TRUE(titled(tables, "Accuracy").table.rows.empty());
  EXPECT_EQ(bench_csv({}).rows.size(), 0U);
}

TEST(BenchTables, NumbersThatAreNoneBecomeADash) {
  BenchCell odd = cell("a", "x", 1, 30);
  odd.metrics.evaluation.t_rel_pct.reset();
  odd.metrics.ms = {};
  EXPECT_FALSE(value_of(odd, bench_figure("t_rel_pct")).has_value());
  EXPECT_FALSE(value_of(odd, bench_figure("ms_max")).has_value());
  EXPECT_EQ(shown(std::nullopt, 2), "-");
  EXPECT_THROW(bench_figure("no_such"), std::logic_error);
}

TEST(BenchProcess, ACellSurvivesTheWayBetweenProcessesWithoutLoss) {
  BenchCell one = cell("a", "x", 1.0 / 3, 3);
  one.settings = {"icp.gate=2"};
  const nlohmann::json there = nlohmann::json::parse(packed(one).dump());
  const BenchCell back = unpacked(there);
  EXPECT_EQ(packed(back), packed(one));
  ASSERT_TRUE(back.kitti.has_value());
  EXPECT_EQ(back.kitti->t_rel_pct(), one.kitti->t_rel_pct());
  EXPECT_EQ(unpacked(packed(failed("b", "x"))).error_code, kBadData);
}

TEST(BenchBaseline, NewMinusOldAndWhatOnlyOneHas) {
  const TempDir folder;
  BenchRecord old;
  old.cells = {cell("a", "x", 1, 30), cell("b", "gone", 1, 30)};
  const auto file = folder.write("results.json", results_json(old).dump());
  const TitledTable table =
      baseline_table({cell("a", "x", 0.75, 30), cell("c", "new", 1, 30)}, read_saved_results(file), file);
  ASSERT_EQ(table.table.rows.size(), 1U);
  EXPECT_EQ(table.table.rows[0][2], "-0.2500");
  EXPECT_EQ(table.table.rows[0][4], "+0.0000");
  EXPECT_THAT(table.note, HasSubstr("not in the baseline: c × new"));
  EXPECT_THAT(table.note, HasSubstr("only in the baseline: b × gone"));
}

TEST(SavedResults, AnythingElseIsRefused) {
  const TempDir folder;
  for (const char* text :
       {"", "[]", "{", "{\"rilo_bench\": 2, \"cells\": []}", "{\"rilo_bench\": 1}",
        "{\"rilo_bench\": 1, \"cells\": [1]}",
        "{\"rilo_bench\": 1, \"cells\": [{\"sequence\": 1, \"configuration\": \"\", \"figures\": {}}]}",
        "{\"rilo_bench\": 1, \"cells\": [{\"sequence\": \"\", \"configuration\": \"\"}]}", "\xff\xfe"}) {
    const auto file = folder.write("results.json", text);
    test::expect_io_error([&] { read_saved_results(file); }, {"results.json or results.sqlite of rilo bench"});
  }
  test::expect_io_error([&] { read_saved_results(folder / "none"); }, {"none", "Check the path"});
  std::filesystem::remove(folder / "results.json");
  test::expect_io_error([&] { read_saved_results(folder.path()); }, {"results.sqlite", "no file of this name"});
}

}  // namespace
}  // namespace rilo
