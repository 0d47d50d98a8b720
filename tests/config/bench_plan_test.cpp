// Plans of a benchmark: what they say, and whatever the bytes, read or refused with a ConfigError.
#include "config/bench_plan.hpp"

#include <filesystem>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

BenchPlan plan_of(const std::string& yaml) { return parse_bench_plan(yaml, "folder/plan.yaml"); }

std::string plan_message(const std::string& yaml) {
  try {
    plan_of(yaml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BenchPlan, a_whole_plan) {
  const BenchPlan plan = plan_of(R"(
sequences:
  - path: drives/one/
  - name: two
    path: /data/two
    ground_truth: truth/two.txt
    calibration: sensors/two.yaml
    pose_frame: camera
    max_gap_s: 0.5
    start: 3
    count: 20
    point_times: azimuth
    elevation_correction: 0.205
    peers: {KISS: peers/kiss.txt, other: /peers/other.tum}
configurations:
  - name: full
  - name: tight
    set: [icp.gate=2, coarse.enabled=false]
  - {name: given, elevation_correction: 0.205}
)");
  ASSERT_EQ(plan.sequences.size(), 2U);
  EXPECT_EQ(plan.sequences[0].name, "one");
  EXPECT_EQ(plan.sequences[0].path, "folder/drives/one/");
  EXPECT_TRUE(plan.sequences[0].ground_truth.empty());
  EXPECT_FALSE(plan.sequences[0].point_times.has_value());
  const BenchSequence& two = plan.sequences[1];
  EXPECT_EQ(two.path, "/data/two");
  EXPECT_EQ(two.ground_truth, "folder/truth/two.txt");
  EXPECT_EQ(two.calibration, "folder/sensors/two.yaml");
  EXPECT_TRUE(two.camera_frame);
  EXPECT_EQ(two.max_gap_s, 0.5);
  EXPECT_EQ(two.start, 3U);
  EXPECT_EQ(two.count, 20U);
  EXPECT_EQ(two.point_times, PointTimes::kAzimuth);
  EXPECT_EQ(two.elevation_correction_deg, 0.205);
  ASSERT_EQ(two.peers.size(), 2U);
  EXPECT_EQ(two.peers[0].name, "KISS");
  EXPECT_EQ(two.peers[0].poses, "folder/peers/kiss.txt");
  ASSERT_EQ(plan.configurations.size(), 3U);
  EXPECT_EQ(plan.configurations[1].config.icp.gate, 2.0);
  EXPECT_FALSE(plan.configurations[1].config.coarse.enabled);
  EXPECT_TRUE(plan.configurations[0].config.coarse.enabled);
  EXPECT_THAT(plan.configurations[1].settings, ElementsAre("icp.gate=2", "coarse.enabled=false"));
  EXPECT_THAT(plan.configurations[2].settings,
              ElementsAre("elevation 0.205°"));  // else it would look like the defaults
}

TEST(BenchPlan, peers_of_every_sequence) {
  BenchPlan plan = plan_of(R"(
sequences:
  - {path: drives/one, group: tuning}
  - {path: drives/two, peers: {KISS: mine.txt}}
peers: {KISS: "peers/{sequence}/kiss_{sequence}.txt", other: "/p/{sequence}.tum"}
peer_figures: peers/figures.csv
)");
  EXPECT_EQ(plan.peer_figures, "folder/peers/figures.csv");
  EXPECT_EQ(plan.sequences[0].group, "tuning");
  EXPECT_TRUE(plan.sequences[1].group.empty());
  give_peers(plan);
  ASSERT_EQ(plan.sequences[0].peers.size(), 2U);
  EXPECT_EQ(plan.sequences[0].peers[0].poses, "folder/peers/one/kiss_one.txt");
  EXPECT_EQ(plan.sequences[0].peers[1].poses, "/p/one.tum");
  ASSERT_EQ(plan.sequences[1].peers.size(), 2U);
  EXPECT_EQ(plan.sequences[1].peers[0].poses, "folder/mine.txt");
  EXPECT_EQ(plan.sequences[1].peers[1].poses, "/p/two.tum");
  EXPECT_THAT(plan_message("sequences: [{path: a}]\nconfigurations: [{name: KISS}]\npeers: {KISS: a.txt}"),
              HasSubstr("\"KISS\" is both a configuration and a peer"));
}

TEST(BenchPlan, sequences_count_from_the_root_and_configurations_from_the_file) {
  const BenchPlan plan = parse_bench_plan("sequences: [{path: a, peers: {p: p.txt}}]", "folder/plan.yaml", "root");
  EXPECT_EQ(plan.sequences.at(0).path, "root/a");
  EXPECT_EQ(plan.sequences.at(0).peers.at(0).poses, "root/p.txt");
  EXPECT_THAT(plan_message("configurations: [{name: a, config: none.yaml}]"), HasSubstr("folder/none.yaml"));
}

TEST(BenchPlan, without_configurations_there_is_the_default_one) {
  const BenchPlan plan = plan_of("sequences: [{path: a}]");
  ASSERT_EQ(plan.configurations.size(), 1U);
  EXPECT_EQ(plan.configurations[0].name, "default");
}

TEST(BenchPlan, refusals_say_where_and_what) {
  const std::pair<const char*, std::vector<const char*>> cases[] = {
      {"[a]", {"plan.yaml", "line 1", "a list"}},
      {"", {"plan.yaml", "sequences"}},
      {"sequences: []", {"empty list"}},
      {"sequences: a", {"\"a\"", "a list"}},
      {"sequences: [{ path: a }]\nconfigurations: [a]", {"\"a\"", "configurations such as { name: NAME }"}},
      {"sequences: [a]", {"line 1, column 13", "\"a\"", "sequences such as { path: DRIVE }"}},
      {"sequences: [{name: a}]", {"without path"}},
      {"sequences: [{path: ''}]", {"a path"}},
      {"sequences: [{path: a}, {path: b/a}]", {"\"a\" a second time"}},
      {"sequences: [{path: a, path: b}]", {"second time"}},
      {"sequences: [{path: a, pth: b}]", {"column 23", "unknown key \"pth\"", "ground_truth"}},
      {"sequences: [{path: a, start: -1}]", {"start", "\"-1\"", "whole number"}},
      {"sequences: [{path: a, count: 1.5}]", {"count", "whole number"}},
      {"sequences: [{path: a, count: '5'}]", {"count", "whole number"}},
      {"sequences: [{path: a, max_gap_s: nan}]", {"max_gap_s", "a number"}},
      {"sequences: [{path: a, elevation_correction: 11}]", {"-10", "10"}},
      {"sequences: [{path: a, point_times: guess}]", {"auto, azimuth, order or none"}},
      {"sequences: [{path: a, peers: [b]}]", {"a map of names"}},
      {"sequences: [{path: a, peers: {b: }}]", {"no value"}},
      {"sequences: [{path: a, peers: {full: b}}]\nconfigurations: [{name: full}]", {"full", "a peer of a"}},
      {"sequences: [{path: a}]\nconfigurations: [{set: [icp.gate=2]}]", {"line 2", "without name"}},
      {"configurations: [{name: a}, {name: a}]", {"\"a\" a second time"}},
      {"configurations:\n  - name: a\n    set: [icp.gate=2, icp.gat=3]", {"line 3, column 23", "icp.gate?"}},
      {"configurations: [{name: a, set: [icp.gate]}]", {"key=value"}},
      {"configurations: [{name: a, set: icp.gate=2}]", {"a list of key=value"}},
      {"configurations: [{name: a, set: [preprocess.max_range_m=2, preprocess.min_range_m=3]}]", {"max_range_m"}},
      {"a: b: c", {"not valid YAML"}},
      {"sequences: [{path: a}]\n---\nb: c", {"second document"}},
  };
  for (const auto& [yaml, parts] : cases) {
    const std::string message = plan_message(yaml);
    for (const char* part : parts) EXPECT_THAT(message, HasSubstr(part)) << yaml;
  }
}

TEST(BenchPlan, files_that_are_none) {
  EXPECT_THROW(load_bench_plan("no/such/plan.yaml"), ConfigError);
  EXPECT_THROW(load_bench_plan(std::filesystem::temp_directory_path()), ConfigError);
}

TEST(BenchPlan, shipped_experiments_load) {
  const std::filesystem::path folder = std::filesystem::path(RILO_SOURCE_DIR) / "experiments";
  const BenchPlan ablation = load_bench_plan(folder / "ablation.yaml", "drives");
  ASSERT_EQ(ablation.configurations.size(), 4U);
  EXPECT_FALSE(ablation.configurations[0].config.coarse.enabled);
  EXPECT_FALSE(ablation.configurations[0].config.icp.adaptive);
  EXPECT_TRUE(ablation.configurations[3].settings.empty());
  EXPECT_EQ(ablation.sequences.at(0).path, "drives/urban00");
  EXPECT_EQ(load_bench_plan(folder / "selection.yaml").configurations.size(), 5U);
  // The paper's values: five of each of the three, the middle one shared.
  EXPECT_EQ(load_bench_plan(folder / "sensitivity.yaml").configurations.size(), 13U);
}

TEST(BenchPlan, shipped_paper_experiments_load) {
  const std::filesystem::path folder = std::filesystem::path(RILO_SOURCE_DIR) / "experiments" / "paper";
  const BenchPlan table_1 = load_bench_plan(folder / "table1.yaml", "kitti");
  EXPECT_EQ(table_1.sequences.size(), 11U);
  EXPECT_EQ(table_1.sequences.at(10).path, "kitti/sequences/10");
  EXPECT_EQ(table_1.tables, PaperTables::kKitti);
  EXPECT_TRUE(table_1.skip_missing);
  ASSERT_EQ(table_1.configurations.size(), 3U);
  EXPECT_EQ(table_1.configurations[1].elevation_correction_deg, 0.205);
  EXPECT_FALSE(table_1.configurations[1].config.elevation.enabled);
  EXPECT_TRUE(table_1.configurations[2].config.elevation.enabled);
  EXPECT_EQ(load_bench_plan(folder / "table2.yaml").repeats, 3U);
  const BenchPlan table_3 = load_bench_plan(folder / "table3.yaml", "m2dgr");
  EXPECT_EQ(table_3.tables, PaperTables::kM2dgr);
  EXPECT_EQ(table_3.sequences.at(0).ground_truth, "m2dgr/hall_01.txt");
  EXPECT_EQ(load_bench_plan(folder / "ablation.yaml").configurations.size(), 4U);
  EXPECT_EQ(load_bench_plan(folder / "sensitivity.yaml").configurations.size(), 13U);
}

void read_or_refuse(const std::string& yaml) {
  try {
    plan_of(yaml);
  } catch (const ConfigError&) {  // any other exception fails the test by itself
  }
}

TEST(BenchPlan, hostile_bytes) {
  const std::string good =
      "sequences:\n  - {name: a, path: b, start: 1, peers: {c: d}}\nconfigurations:\n"
      "  - name: e\n    set: [icp.gate=2, threads=1]\n";
  for (std::size_t length = 0; length <= good.size(); ++length) read_or_refuse(good.substr(0, length));
  std::mt19937 random(3);
  const std::string signs = "{}[]:,-?&*!|>'\"%@`#~ \n\tab01.\\";
  for (int round = 0; round < 3000; ++round) {
    std::string broken = good;
    for (int i = 0; i < 3; ++i) {
      broken[random() % broken.size()] =
          round % 2 == 0 ? static_cast<char>(random() % 256) : signs[random() % signs.size()];
    }
    read_or_refuse(broken);
  }
}

TEST(BenchPlan, hostile_structures) {
  read_or_refuse(std::string(20000, '['));
  read_or_refuse("sequences: " + std::string(20000, '{'));
  read_or_refuse("sequences: &a [*a]");
  read_or_refuse("sequences: &a [{path: a, peers: *a}]");
  read_or_refuse("sequences: [&a {path: x, peers: *a}]");
  read_or_refuse("configurations: [{name: a, set: &b [*b]}]");
  read_or_refuse("configurations: [{name: a, set: [{}]}]");
  read_or_refuse("configurations: [{name: a, set: [~]}]");
  read_or_refuse("? [sequences]\n: []");
  read_or_refuse("sequences: [{path: *none}]");
  read_or_refuse("sequences: [{path: " + std::string(100000, 'p') + "}]");
  read_or_refuse(std::string("sequences: [{path: a\0}]", 23));
}

}  // namespace
}  // namespace rilo
