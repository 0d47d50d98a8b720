// rilo bench: several cells at a time, nothing run twice, nothing lost.
#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// Three sequences of that many sweeps and two configurations.
fs::path six_cells(const TempDir& folder, const fs::path& data, int sweeps) {
  std::string plan = "sequences:\n";
  for (int i = 0; i < 3; ++i) {
    plan += "  - {name: s" + std::to_string(i) + ", path: '" + data.string() + "', start: " + std::to_string(i) +
            ", count: " + std::to_string(sweeps) + "}\n";
  }
  return folder.write("plan.yaml", plan +
                                       "configurations:\n  - name: full\n  - name: A\n    set: "
                                       "[coarse.enabled=false]\n");
}

// What lies in the folder of cells, with the time it was written.
std::map<std::string, fs::file_time_type> cells_in(const fs::path& out) {
  std::map<std::string, fs::file_time_type> cells;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(out / "cells", none)) {
    if (entry.path().extension() == ".json") cells[entry.path().filename().string()] = entry.last_write_time();
  }
  return cells;
}

std::string lasting_tables(const fs::path& out, const std::string& format = "markdown") {
  return rilo_succeeds({"bench", "show", out, "--no-times", "--format", format}).out;
}

TEST(BenchResume, SeveralAtATimeGiveTheTablesOfOneAtATime) {
  const TempDir folder;
  const auto plan = six_cells(folder, shared_drive(), 4);
  rilo_succeeds({"bench", plan, "--out", folder / "one", "--quiet"});
  const Outcome three = rilo_succeeds({"bench", plan, "--out", folder / "three", "--jobs", "3"});
  EXPECT_THAT(three.err, HasSubstr("[6/6]"));
  EXPECT_THAT(three.err, HasSubstr("t_rel"));
  for (const char* format : {"text", "markdown", "csv"}) {
    EXPECT_EQ(lasting_tables(folder / "one", format), lasting_tables(folder / "three", format));
  }
  const std::string tables = lasting_tables(folder / "one");
  EXPECT_THAT(tables, HasSubstr("| s0 | full |"));
  EXPECT_THAT(tables, Not(HasSubstr("ms mean")));
  EXPECT_THAT(tables, Not(HasSubstr("peak MiB")));
  const Outcome all = rilo_succeeds({"bench", "show", folder / "three" / "results.sqlite"});
  EXPECT_THAT(three.out, HasSubstr(all.out));
}

TEST(BenchResume, FinishedCellsAreNotRunAgainUnlessSomethingChanged) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  const auto plan = six_cells(folder, drive, 3);
  const auto out = folder / "out";
  rilo_succeeds({"bench", plan, "--out", out, "--quiet", "--jobs", "2"});
  const auto before = cells_in(out);
  ASSERT_EQ(before.size(), 6U);
  const Outcome again = rilo_succeeds({"bench", plan, "--out", out, "--jobs", "2", "--threads", "1"});
  EXPECT_THAT(again.err, HasSubstr("6 of 6 cells are finished already"));
  EXPECT_EQ(cells_in(out), before);
  // Another name is none; another configuration, another number of sweeps, other data are.
  const auto renamed = folder.write("renamed.yaml", "sequences: [{name: other, path: '" + drive.string() +
                                                        "', count: 3}]\nconfigurations: [{name: same}]\n");
  EXPECT_THAT(rilo_succeeds({"bench", renamed, "--out", out}).out, HasSubstr("other"));
  EXPECT_EQ(cells_in(out), before);
  rilo_succeeds({"bench", renamed, "--out", out, "--count", "2", "--quiet"});
  EXPECT_EQ(cells_in(out).size(), 7U);
  std::ofstream(drive / "times.txt", std::ios::app) << "\n";
  rilo_succeeds({"bench", renamed, "--out", out, "--quiet"});
  EXPECT_EQ(cells_in(out).size(), 8U);
}

// A rate that is assumed may be changed by the run, one that is given is not.
TEST(BenchResume, AGivenRateIsAnotherRunThanTheSameOneAssumed) {
  const TempDir folder;
  const auto plan =
      folder.write("plan.yaml", "sequences: [{name: s, path: '" + shared_drive().string() + "', count: 2}]\n");
  const auto out = folder / "out";
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  rilo_succeeds({"bench", plan, "--out", out, "--quiet", "--rate", "10"});
  EXPECT_EQ(cells_in(out).size(), 2U);
}

TEST(BenchResume, AChangedCalibrationIsRunAgain) {
  const TempDir folder;
  const std::string yaml = "elevation_offset_deg: 0.1\nbeams: []\n...\n";
  folder.write("c.yaml", yaml);
  const auto plan = folder.write(
      "plan.yaml", "sequences: [{path: '" + shared_drive().string() + "', count: 2, calibration: c.yaml}]\n");
  const auto out = folder / "out";
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  const json metrics = json_file(out / "results.json")["cells"][0]["metrics"];
  EXPECT_EQ(metrics["elevation_given_deg"], 0.1);
  EXPECT_EQ(metrics["calibration"], (folder / "c.yaml").string());
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  EXPECT_EQ(cells_in(out).size(), 1U);
  folder.write("c.yaml", "# another\n" + yaml);
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  EXPECT_EQ(cells_in(out).size(), 2U);
}

TEST(BenchResume, AKilledBenchmarkGoesOnWhereItWas) {
  const TempDir folder;
  const auto plan = six_cells(folder, shared_drive(), 9);
  const auto out = folder / "out";
  std::set<pid_t> children;
  {
    CommandProcess bench({"bench", plan, "--out", out, "--jobs", "2", "--threads", "1", "--quiet"});
    ASSERT_TRUE(bench.wait_until([&] { return cells_in(out).size() >= 2 && !children_of(bench.pid()).empty(); }));
    children = children_of(bench.pid());
    bench.send(SIGKILL);
    EXPECT_EQ(bench.wait().signal, SIGKILL);
  }
  for (const pid_t child : children) {  // nothing goes on in the background
    for (int i = 0; i < 500 && ::kill(child, 0) == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_NE(::kill(child, 0), 0);
  }
  const auto before = cells_in(out);
  ASSERT_LT(before.size(), 6U);
  rilo_succeeds({"bench", plan, "--out", out, "--jobs", "2", "--threads", "1", "--quiet"});
  const auto after = cells_in(out);
  EXPECT_EQ(after.size(), 6U);
  for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << "run again: " << name;
  rilo_succeeds({"bench", plan, "--out", folder / "whole", "--jobs", "2", "--threads", "1", "--quiet"});
  EXPECT_EQ(lasting_tables(out), lasting_tables(folder / "whole"));
}

TEST(BenchResume, KilledCellsAreRetriedAsTold) {
  const TempDir folder;
  const auto plan = six_cells(folder, long_folder(folder, 40), 30);
  const auto out = folder / "out";
  CommandProcess bench({"bench", plan, "--out", out, "--jobs", "2", "--threads", "1", "--retries", "1"});
  std::set<pid_t> killed;
  ASSERT_TRUE(bench.wait_until([&] {
    for (const pid_t child : children_of(bench.pid())) {
      if (killed.size() < 2 && killed.insert(child).second) ::kill(child, SIGKILL);
    }
    return killed.size() >= 2;
  }));
  const Outcome outcome = bench.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(cells_in(out).size(), 6U);
  std::size_t twice = 0;
  for (const auto& [name, time] : cells_in(out)) twice += json_file(out / "cells" / name)["attempts"] == 2 ? 1U : 0U;
  EXPECT_EQ(twice, 2U);
}

TEST(BenchResume, AFailedCellIsListedWithItsLogAndRunAgainTheNextTime) {
  const TempDir folder;
  const auto drive = copy_of_drive(folder);
  append(sweep_file(drive, 1), 3);
  const auto plan = folder.write("plan.yaml", "sequences:\n  - {name: broken, path: '" + drive.string() +
                                                  "'}\n  - {name: good, path: '" + shared_drive().string() + "'}\n");
  const auto out = folder / "out";
  const Outcome bench = rilo_fails(3, {"bench", plan, "--out", out, "--retries", "1", "--count", "3"},
                                   {"1 of 2 cells failed", "000001.bin"});
  EXPECT_THAT(bench.out, HasSubstr("(log: cells/"));
  const std::string log = json_file(out / "results.json")["cells"][0]["log"];
  EXPECT_THAT(slurp(out / log), HasSubstr("attempt 1"));
  EXPECT_THAT(slurp(out / log), HasSubstr("attempt 2"));
  EXPECT_THAT(slurp(out / log), HasSubstr("000001.bin"));
  EXPECT_THAT(rilo_succeeds({"bench", "show", out}).out, HasSubstr("failed: broken"));
  const auto before = cells_in(out);
  fs::copy_file(sweep_file(shared_drive(), 1), sweep_file(drive, 1), fs::copy_options::overwrite_existing);
  const Outcome again = rilo_succeeds({"bench", plan, "--out", out, "--count", "3"});
  EXPECT_THAT(again.err, HasSubstr("1 of 2 cells are finished already"));
  EXPECT_THAT(again.out, Not(HasSubstr("failed")));
}

TEST(BenchResume, RepeatsAreOneRowWithTheirMedian) {
  const TempDir folder;
  const auto plan =
      folder.write("plan.yaml", "repeats: 3\nsequences: [{path: '" + shared_drive().string() + "', count: 4}]\n");
  rilo_succeeds({"bench", plan, "--out", folder / "out", "--quiet"});
  EXPECT_EQ(cells_in(folder / "out").size(), 3U);
  const json results = json_file(folder / "out" / "results.json");
  EXPECT_EQ(results["cells_planned"], 3);
  ASSERT_EQ(results["cells"].size(), 1U);
  EXPECT_EQ(results["cells"][0]["metrics"]["repeats"], 3);
  EXPECT_EQ(lines_with(slurp(folder / "out" / "results.csv"), "cell,").size(), 1U);
}

TEST(BenchResume, ADamagedCellIsRunAgainAndADamagedStoreRefused) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences: [{path: '" + shared_drive().string() + "', count: 3}]\n");
  const auto out = folder / "out";
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  const std::string tables = lasting_tables(out);
  replace(out / "cells" / cells_in(out).begin()->first, "{\"rilo_cell\": 1,");
  replace(out / "results.sqlite", "SQLite format 3");
  rilo_fails(3, {"bench", "show", out}, {"results.sqlite"});
  rilo_fails(3, {"bench", "show", folder / "nothing"}, {"nothing"});
  rilo_succeeds({"bench", plan, "--out", out, "--quiet"});
  EXPECT_EQ(lasting_tables(out), tables);
}

TEST(BenchResume, MissingSequencesAreLeftOutWhereThePlanSaysSo) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "skip_missing: true\nsequences: [{path: drive}, {path: nowhere}]\n");
  const Outcome bench =
      rilo_succeeds({"bench", plan, "--root", shared_drive().parent_path(), "--count", "3", "--jobs", "2"});
  EXPECT_THAT(bench.err, HasSubstr("skipped, as they do not exist"));
  EXPECT_THAT(bench.err, HasSubstr("nowhere"));
  rilo_fails(3, {"bench", plan, "--root", folder.path()}, {"nowhere", "--root"});
}

TEST(BenchResume, ConflictingOptionsAreRefused) {
  const TempDir folder;
  const auto plan = folder.write("plan.yaml", "sequences: [{path: drive}]\n");
  rilo_fails(2, {"bench", plan, "--on", "slurm"}, {"--out"});
  rilo_fails(2, {"bench", plan, "--on", "moon"}, {"--on"});
  rilo_fails(2, {"bench", plan, "--sbatch=--time=1"}, {"--on slurm"});
  rilo_fails(2, {"bench", folder.write("none.yaml", "repeats: 0\nsequences: [{path: drive}]\n")}, {"repeats"});
}

}  // namespace
}  // namespace rilo::test
