// rilo bench FILE.
#include <algorithm>
#include <csignal>
#include <set>
#include <sys/types.h>

#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const char* const kConfigurations = "configurations:\n  - name: full\n  - name: A\n    set: [coarse.enabled=false]\n";

std::string sequence(const std::string& name, const fs::path& path, const std::string& more = "") {
  return "  - {name: " + name + ", path: '" + path.string() + "'" + more + "}\n";
}

// "sequence × configuration" of each cell.
json cell_of(const json& results, const std::string& sequence_name, const std::string& configuration) {
  for (const json& cell : results["cells"]) {
    if (cell["sequence"] == sequence_name && cell["configuration"] == configuration) return cell;
  }
  return nullptr;
}

TEST(BenchCommand, TwoSequencesTimesTwoConfigurations) {
  const TempDir folder;
  const auto plan =
      folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()) +
                                    sequence("short", shared_drive(), ", start: 2, count: 5") + kConfigurations);
  const Outcome bench = rilo_succeeds({"bench", plan, "--out", folder / "out", "--threads", "1"});
  expect_parts(bench.out, {"Accuracy", "Effort", "Averages", "t_rel % pooled", "APE rmse m", "p99", "peak MiB"});
  const json results = json_file(folder / "out" / "results.json");
  ASSERT_EQ(results["cells"].size(), 4U);
  EXPECT_EQ(results["cells_run"], 4);
  EXPECT_EQ(cell_of(results, "short", "A")["metrics"]["frames"], 5);
  EXPECT_EQ(cell_of(results, "one", "full")["metrics"]["frames"], kDriveSweeps);
  EXPECT_EQ(cell_of(results, "one", "A")["metrics"]["coarse_runs"], 0);
  EXPECT_GT(cell_of(results, "one", "full")["metrics"]["coarse_runs"], 0);
  EXPECT_EQ(lines_with(slurp(folder / "out" / "results.csv"), "cell,").size(), 4U);
  EXPECT_THAT(slurp(folder / "out" / "results.md"), HasSubstr("| one | full | 12 |"));
}

TEST(BenchCommand, FiguresAreThoseOfARun) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()));
  rilo_succeeds({"bench", plan, "--out", folder / "bench", "--quiet"});
  rilo_succeeds({"run", shared_drive(), "--out", folder / "run", "--quiet"});
  const json cell = cell_of(json_file(folder / "bench" / "results.json"), "one", "default");
  const json run = json_file(folder / "run" / "metrics.json");
  EXPECT_EQ(cell["metrics"]["evaluation"], run["evaluation"]);
  EXPECT_EQ(cell["figures"]["t_rel_pct"], run["t_rel_pct"]);
  EXPECT_EQ(cell["figures"]["mean_iterations"], run["mean_iterations"]);
}

TEST(BenchCommand, ABrokenCellIsListedAndTheOthersRun) {
  const TempDir folder;
  const auto broken = copy_of_drive(folder);
  append(sweep_file(broken, 4), 3);
  const auto plan =
      folder.write("plan.yaml", "sequences:\n" + sequence("broken", broken) + sequence("none", folder / "nowhere") +
                                    sequence("good", shared_drive()) + kConfigurations);
  const Outcome bench = rilo_fails(3, {"bench", plan, "--out", folder / "out", "--count", "6", "--quiet"},
                                   {"4 of 6 cells failed", "broken × full", "000004.bin"});
  EXPECT_THAT(bench.out, HasSubstr("failed: none × A"));
  const json results = json_file(folder / "out" / "results.json");
  ASSERT_EQ(results["cells"].size(), 6U);
  EXPECT_FALSE(cell_of(results, "good", "A").contains("error"));
  EXPECT_THAT(cell_of(results, "none", "full")["error"].get<std::string>(), HasSubstr("nowhere"));
  EXPECT_THAT(slurp(folder / "out" / "results.md"), HasSubstr("000004.bin"));
}

TEST(BenchCommand, AWrongRootIsOneErrorAndNoCells) {
  const TempDir folder;
  const auto plan = folder.write(
      "plan.yaml", std::string("sequences:\n") + sequence("a", "a") + sequence("b", "b") + kConfigurations);
  const Outcome bench = rilo_fails(3, {"bench", plan, "--root", folder / "nowhere", "--out", folder / "out"},
                                   {"none of its sequences is there", "nowhere/a", "--root"});
  EXPECT_THAT(bench.out, Not(HasSubstr("failed")));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BenchCommand, PeakMemoryIsOfEachCellAlone) {
  const TempDir folder;
  const auto plan =
      folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()) +
                                    "configurations:\n  - name: many points\n"
                                    "    set: [preprocess.source_points=1000000, preprocess.min_voxel_m=0.01]\n"
                                    "  - name: few points\n"
                                    "    set: [preprocess.source_points=500, map.levels=1]\n");
  rilo_succeeds({"bench", plan, "--out", folder / "out", "--quiet", "--threads", "1"});
  const json results = json_file(folder / "out" / "results.json");
  const double many = cell_of(results, "one", "many points")["figures"]["peak_rss_mb"];
  const double few = cell_of(results, "one", "few points")["figures"]["peak_rss_mb"];
  EXPECT_GT(few, 0);
  EXPECT_LT(few, many);
}

TEST(BenchCommand, ComparesWithEarlierResults) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()));
  rilo_succeeds({"bench", plan, "--out", folder / "out", "--quiet"});
  const auto other = folder.write("other.yaml", "sequences:\n" + sequence("one", shared_drive()) + kConfigurations);
  const Outcome again = rilo_succeeds({"bench", plan, "--baseline", folder / "out" / "results.json", "--quiet"});
  EXPECT_THAT(again.out, HasSubstr("Difference to"));
  EXPECT_THAT(again.out, HasSubstr("+0.0000"));
  EXPECT_THAT(again.out, Not(HasSubstr("only in the baseline")));
  const Outcome more = rilo_succeeds({"bench", other, "--baseline", folder / "out" / "results.json", "--quiet"});
  EXPECT_THAT(more.out, HasSubstr("not in the baseline: one × A"));
  EXPECT_THAT(more.out, HasSubstr("only in the baseline: one × default"));
  rilo_fails(3, {"bench", plan, "--baseline", plan}, {"not JSON", "results.json"});
}

TEST(BenchCommand, TheStoreAloneIsEnoughForReportsAndDifferences) {
  const TempDir folder;
  const auto out = folder / "out";
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()) + kConfigurations);
  rilo_succeeds({"bench", plan, "--out", out, "--quiet", "--count", "6"});
  rilo_succeeds({"report", out, "-o", folder / "of_json.html"});
  std::filesystem::remove(out / "results.json");
  rilo_succeeds({"report", out, "-o", folder / "of_store.html"});
  EXPECT_EQ(slurp(folder / "of_store.html"), slurp(folder / "of_json.html"));
  EXPECT_THAT(slurp(folder / "of_store.html"), HasSubstr("coarse.enabled=false"));
  rilo_succeeds({"report", out / "results.sqlite", "-o", folder / "of_file.html"});
  const Outcome again = rilo_succeeds({"bench", plan, "--baseline", out / "results.sqlite", "--quiet", "--count", "6"});
  EXPECT_THAT(again.out, HasSubstr("+0.0000"));
  EXPECT_THAT(again.out, Not(HasSubstr("in the baseline")));
  rilo_fails(3, {"report", folder.write("other.sqlite", "no database"), "-o", folder / "no.html"},
             {"other.sqlite", "not a database", "results.sqlite"});
}

TEST(BenchCommand, ComparesWithPoseFiles) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "run", "--quiet"});
  const std::string peers = ", peers: {same: run/poses_lidar.txt, stamped: run/trajectory.tum, none: nothing.txt}";
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive(), peers));
  const Outcome bench =
      rilo_fails(3, {"bench", plan, "--out", folder / "out", "--quiet"}, {"one × none", "nothing.txt"});
  EXPECT_THAT(bench.out, HasSubstr("stamped"));
  const json results = json_file(folder / "out" / "results.json");
  const double ours = cell_of(results, "one", "default")["figures"]["ape_rmse_m"];
  for (const char* peer : {"same", "stamped"}) {
    const json cell = cell_of(results, "one", peer);
    EXPECT_EQ(cell["kind"], "peer");
    EXPECT_NEAR(cell["figures"]["ape_rmse_m"].get<double>(), ours, 1e-5) << peer;
    EXPECT_TRUE(cell["figures"]["ms_mean"].is_null());
  }
}

TEST(BenchCommand, SetsGivenPosesAndFiguresBesideOurs) {
  const TempDir folder;
  rilo_succeeds({"run", shared_drive(), "--out", folder / "peers" / "one", "--quiet"});
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive(), ", group: tuning") +
                                                  sequence("two", shared_drive(), ", count: 6, group: reporting"));
  const auto figures = folder.write("peers.csv",
                                    "drive,peer,t_rel_pct,mean_ms,notes\none,same,99,12.5,a\n"
                                    "one,lost,25.5,3,b\ntwo,lost,nan,,c\nelsewhere,lost,1,1,d\n");
  const std::vector<std::string> command = {"bench",          plan,   "--out", folder / "out", "--quiet",
                                            "--peer-figures", figures};
  std::vector<std::string> with_poses = command;
  with_poses.insert(with_poses.end(), {"--peer", "same=" + (folder / "peers/{sequence}/poses_lidar.txt").string()});
  // The second sequence has no such poses.
  rilo_fails(3, with_poses, {"two × same", "poses_lidar.txt"});
  const json same = cell_of(json_file(folder / "out" / "results.json"), "one", "same");
  EXPECT_LT(same["figures"]["t_rel_pct"].get<double>(), 99);
  EXPECT_EQ(same["figures"]["ms_mean"], 12.5);
  std::vector<std::string> loud = command;
  loud.erase(std::find(loud.begin(), loud.end(), "--quiet"));
  EXPECT_THAT(rilo_succeeds(loud).err,
              HasSubstr("peers.csv: its figures are of whole drives; a part alone is run of two\n"));
  const Outcome bench = rilo_succeeds(command);
  EXPECT_THAT(bench.out, HasSubstr("t_rel over that of the peers"));
  EXPECT_THAT(bench.out, HasSubstr("lost by lost: one, two"));
  const auto rows = lines_with(slurp(folder / "out" / "paired.csv"), "default,lost,");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows[0], HasSubstr("default,lost,all,2,,"));
  EXPECT_THAT(rows[0], HasSubstr(",2,0,"));
  EXPECT_THAT(rows[0], HasSubstr(",,one two"));
  EXPECT_THAT(rows[1], HasSubstr("default,lost,tuning,1,"));
  EXPECT_THAT(rows[2], HasSubstr("default,lost,reporting,1,"));
  EXPECT_EQ(rilo_succeeds({"bench", "show", folder / "out", "--paired", "--format", "csv"}).out,
            slurp(folder / "out" / "paired.csv"));
  EXPECT_THAT(rilo_succeeds({"bench", "show", folder / "out", "--paired", "--format", "markdown"}).out,
              HasSubstr("| default | best peer | all | 2 |"));
  rilo_fails(3, {"bench", plan, "--peer-figures", folder.write("no.csv", "drive,t_rel_pct\none,1\n")},
             {"no.csv", "no column peer"});
  rilo_fails(2, {"bench", plan, "--peer", "nothing"}, {"--peer nothing", "NAME=FILE"});
  // By such a name a baseline and a report would take the one for the other.
  rilo_fails(2, {"bench", plan, "--peer", "default=poses.txt"}, {"--peer default", "both a configuration and a peer"});
  rilo_fails(2, {"bench", plan, "--peer-figures", folder.write("own.csv", "drive,peer,t_rel_pct\none,default,1\n")},
             {"own.csv", "\"default\" is both a configuration and a peer"});
}

TEST(BenchCommand, DataAndRootOfTheCommandLine) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences: [{path: drive}]\n");
  rilo_fails(3, {"bench", plan, "--quiet"}, {"drive"});
  EXPECT_THAT(rilo_succeeds({"bench", plan, "--root", shared_drive().parent_path(), "--count", "3"}).out,
              HasSubstr("drive"));
  rilo_succeeds({"bench", plan, "--data", shared_drive(), "--count", "3"});
  rilo_fails(2, {"bench", folder.write("empty.yaml", kConfigurations)}, {"no sequences", "--data"});
}

TEST(BenchCommand, InterruptedItKeepsWhatIsFinished) {
  const TempDir folder;
  const auto plan = folder.write(
      "plan.yaml", "sequences:\n" + sequence("quick", shared_drive()) + sequence("endless", long_folder(folder, 3000)));
  const fs::path file = folder / "out" / "results.json";
  for (const auto& [signal, code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
    fs::remove(file);
    CommandProcess bench({"bench", plan, "--out", folder / "out", "--threads", "1"});
    EXPECT_TRUE(bench.wait_until([&] { return fs::exists(file); }));
    bench.send(signal);
    const Outcome outcome = bench.wait();
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("1 of 2 cells"));
    EXPECT_THAT(outcome.out, HasSubstr("quick"));
    const json results = json_file(file);
    EXPECT_EQ(results["interrupted"], true);
    ASSERT_EQ(results["cells"].size(), 1U);
    EXPECT_EQ(results["cells"][0]["sequence"], "quick");
  }
}

TEST(BenchCommand, ACellWhoseProcessIsKilledFailsAlone) {
  const TempDir folder;
  const auto plan = folder.write(
      "plan.yaml", "sequences:\n" + sequence("endless", long_folder(folder, 3000)) + sequence("quick", shared_drive()));
  CommandProcess bench({"bench", plan, "--out", folder / "out", "--threads", "1", "--quiet"});
  std::set<pid_t> cells;
  ASSERT_TRUE(bench.wait_until([&] { return !(cells = children_of(bench.pid())).empty(); }));
  ::kill(*cells.begin(), SIGKILL);
  const Outcome outcome = bench.wait();
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("signal 9"));
  const json results = json_file(folder / "out" / "results.json");
  ASSERT_EQ(results["cells"].size(), 2U);
  EXPECT_THAT(cell_of(results, "endless", "default")["error"].get<std::string>(), HasSubstr("memory"));
  EXPECT_FALSE(cell_of(results, "quick", "default").contains("error"));
}

TEST(BenchCommand, WrongPlansEndBeforeAnythingIsRun) {
  const TempDir folder;
  rilo_fails(2, {"bench"}, {"FILE is required"});
  rilo_fails(2, {"bench", folder / "none.yaml"}, {"none.yaml"});
  rilo_fails(2, {"bench", folder.write("a.yaml", "sequences: [{pth: a}]")}, {"a.yaml", "line 1", "pth"});
  const auto good = folder.write("good.yaml", "sequences:\n" + sequence("one", shared_drive()));
  const auto file = folder.write("file", "");
  rilo_fails(4, {"bench", good, "--out", file / "out"}, {"file"});
}

TEST(BenchCommand, ReplacesItsOwnResultsAndNothingElse) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences:\n" + sequence("one", shared_drive()));
  for (const char* name : {"results.csv", "results.json", "paired.csv", "results.sqlite"}) {
    const fs::path mine = folder.write(std::string(name) + ".d/" + name, "mine");
    rilo_fails(4, {"bench", plan, "--out", mine.parent_path()}, {name, "would be replaced", "choose another --out"});
    EXPECT_EQ(slurp(mine), "mine");
  }
  const fs::path drive = copy_of_drive(folder);
  const auto of_drive = folder.write("drive.yaml", "sequences:\n" + sequence("one", drive));
  for (const fs::path& data : {drive, drive / "velodyne"}) {
    rilo_fails(4, {"bench", of_drive, "--out", data}, {"holds data", "a folder of its own"});
  }
  EXPECT_FALSE(fs::exists(drive / "results.json"));
  const fs::path out = folder / "out";
  const std::vector<std::string> command = {"bench", plan, "--out", out, "--quiet", "--count", "6"};
  rilo_succeeds(command);
  replace(out / "paired.csv", "of a plan that had peers");
  fs::remove_all(out / "cells");  // to run all again
  rilo_succeeds(command);
  EXPECT_FALSE(fs::exists(out / "paired.csv"));
}

}  // namespace
}  // namespace rilo::test
