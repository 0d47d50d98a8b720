// Parts of experiments at scale: content hashes, the files of cells, the store, repeats, Slurm's lists.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/cell_file.hpp"
#include "bench/content_hash.hpp"
#include "bench/output.hpp"
#include "bench/slurm_commands.hpp"
#include "bench/store.hpp"
#include "io/io_test_util.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

namespace fs = std::filesystem;
using test::TempDir;
using testing::ElementsAre;

BenchCell made_cell(const std::string& sequence, std::size_t repeat, double ms, double ape) {
  BenchCell cell;
  cell.sequence = sequence;
  cell.configuration = "full";
  cell.repeat = repeat;
  cell.metrics.ms.mean = ms;
  cell.metrics.evaluation.ape_m.rmse = ape;
  cell.kitti = KittiError{};
  cell.kitti->segments = {{1, 2, 100, 0.25, 0.1}};
  return cell;
}

BenchJob made_job(const fs::path& data) {
  BenchJob job;
  job.sequence.name = "a";
  job.sequence.path = data;
  job.configuration.name = "full";
  return job;
}

std::string key_of(const BenchJob& job, const BenchRunOptions& flags = {}) {
  std::vector<BenchJob> jobs = {job};
  describe(jobs, flags, {});
  return jobs.front().key;
}

TEST(ContentHash, IsThatOfTheStandard) {
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TempDir folder;
  EXPECT_EQ(hash_of_file(folder.write("f", "abc")), hash_of("abc"));
  EXPECT_EQ(hash_of_file(folder / "none"), "missing");
  EXPECT_EQ(hash_of_program().size(), 64U);
}

TEST(ContentHash, DataChangeWhenTheirFilesDo) {
  const TempDir folder;
  folder.write("drive/velodyne/000000.bin", "sweep");
  folder.write("drive/times.txt", "0\n");
  const auto now = [&] { return hash_of_data(folder / "drive", folder / "drive/out"); };
  const std::string before = now();
  folder.write("drive/out/results.txt", "ours");
  folder.write("drive/photo.jpg", "not ours");
  fs::last_write_time(folder / "drive/times.txt", fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(now(), before);
  folder.write("drive/times.txt", "1\n");
  const std::string other_times = now();
  EXPECT_NE(other_times, before);
  fs::last_write_time(folder / "drive/velodyne/000000.bin", fs::file_time_type::clock::now() + std::chrono::hours(1));
  const std::string other_sweep = now();
  EXPECT_NE(other_sweep, other_times);
  folder.write("drive/velodyne/000001.bin", "sweep");
  EXPECT_NE(now(), other_sweep);
}

TEST(ContentHash, DataChangeWithWhatIsReadOfThemOrBesideThem) {
  const TempDir folder;
  folder.write("day/drive/notes.txt", "");
  std::string before = hash_of_data(folder / "day/drive", {});
  // Of any case, packed, and what lies beside: a rosbag2's packed file; calibrations, stamps and metadata.
  for (const char* name : {"day/drive/0.PCD", "day/drive/bag.db3.zstd", "day/drive/ring.pcap1",
                           "day/calib_imu_to_velo.txt", "day/times.txt", "day/timestamps.txt", "day/drive.json"}) {
    folder.write(name, "x");
    const std::string after = hash_of_data(folder / "day/drive", {});
    EXPECT_NE(after, before) << name;
    before = after;
  }
}

TEST(BenchKey, DependsOnAllThatTheResultDependsOn) {
  const TempDir folder;
  folder.write("drive/0.bin", "sweep");
  const BenchJob job = made_job(folder / "drive");
  const std::string key = key_of(job);
  EXPECT_EQ(key.size(), 32U);
  BenchJob same = job;
  same.sequence.name = same.configuration.name = "renamed";
  same.configuration.config.threads = 7;
  EXPECT_EQ(key_of(same), key);
  const auto differs = [&](const std::function<void(BenchJob&)>& change) {
    BenchJob other = job;
    change(other);
    return key_of(other) != key;
  };
  EXPECT_TRUE(differs([](BenchJob& j) { j.repeat = 2; }));
  EXPECT_TRUE(differs([](BenchJob& j) { j.sequence.count = 5; }));
  EXPECT_TRUE(differs([](BenchJob& j) { j.sequence.start = 5; }));
  EXPECT_TRUE(differs([](BenchJob& j) { j.sequence.elevation_correction_deg = 0.205; }));
  EXPECT_TRUE(differs([](BenchJob& j) { j.configuration.config.coarse.enabled = false; }));
  EXPECT_TRUE(differs([&](BenchJob& j) { j.sequence.ground_truth = folder.write("truth.txt", "1"); }));
  EXPECT_TRUE(differs([&](BenchJob& j) { j.sequence.peers = {{"p", folder.write("peer.txt", "1")}}; }));
  BenchRunOptions flags;
  flags.source.options.bin_fields = "x,y,z";
  EXPECT_NE(key_of(job, flags), key);
}

TEST(CellFolder, GivesBackWhatWasWrittenAndNothingElse) {
  const TempDir folder;
  const CellFolder cells(folder / "out", true);
  BenchJob job = made_job(folder / "drive");
  job.key = "k";
  EXPECT_FALSE(cells.read(job));
  cells.write(job, {{made_cell("a", 1, 12.5, 0.5)}, 2, cells.log_name(job), "here"});
  const auto record = cells.read(job);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->attempts, 2U);
  EXPECT_EQ(record->log, "cells/k.log");
  EXPECT_EQ(packed(record->cells.at(0)), packed(made_cell("a", 1, 12.5, 0.5)));
  const std::string whole = test::slurp(cells.file(job));
  for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() / 2), std::string("{}"),
                                     std::string("[1]"), std::string(R"({"rilo_cell":1,"key":"other"})")}) {
    folder.write("out/cells/k.json", damaged);
    EXPECT_FALSE(cells.read(job)) << damaged;
  }
}

TEST(BenchStore, GivesBackWhatWasWritten) {
  const TempDir folder;
  BenchStore store;
  store.bench.command_line = "rilo bench 'it''s'";
  store.bench.planned = 3;
  store.bench.run = 2;
  store.tables = PaperTables::kKitti;
  store.cells = {{made_cell("a", 1, 12.5, 0.5), "key", 2, "here"}, {made_cell("ä \"b\"", 2, 1e-9, 0.1), "k", 1, ""}};
  store.cells[1].cell.error = "failed";
  store.cells[1].cell.log = "cells/k.log";
  write_store(folder / kStoreName, store);
  const BenchStore read = read_store(folder.path());
  EXPECT_EQ(read.bench.command_line, store.bench.command_line);
  EXPECT_EQ(read.bench.planned, 3U);
  EXPECT_EQ(read.tables, PaperTables::kKitti);
  ASSERT_EQ(read.cells.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(packed(read.cells[i].cell), packed(store.cells[i].cell));
    EXPECT_EQ(read.cells[i].cell.repeat, store.cells[i].cell.repeat);
    EXPECT_EQ(read.cells[i].cell.log, store.cells[i].cell.log);
    EXPECT_EQ(read.cells[i].attempts, store.cells[i].attempts);
  }
  EXPECT_EQ(test::files_in(folder.path()), 1U);  // no journal
}

TEST(BenchStore, RefusesWhatIsNone) {
  const TempDir folder;
  test::expect_io_error([&] { read_store(folder.path()); }, {"results.sqlite", "no file"});
  const auto text = folder.write("text", "no database");
  test::expect_io_error([&] { read_store(text); }, {"text", "SQLite3"});
  const auto empty = folder.write("empty", "");
  test::expect_io_error([&] { read_store(empty); }, {"another kind"});
}

TEST(BenchOutput, WhatCannotBeReplacedIsSaid) {
  const TempDir folder;
  folder.write("paired.csv/in.the.way", "");
  const BenchStore store;
  try {
    write_results(folder.path(), bench_output(store), store);
    FAIL() << "written";
  } catch (const RunError& error) {
    EXPECT_EQ(error.kind(), RunErrorKind::kCannotWrite);
  }
}

TEST(BenchRepeats, TimesAreMediansAndFindingsMustAgree) {
  const auto one = combined(
      {made_cell("a", 1, 30, 0.5), made_cell("b", 1, 1, 1), made_cell("a", 2, 10, 0.5), made_cell("a", 3, 20, 0.5)});
  ASSERT_EQ(one.size(), 2U);
  EXPECT_EQ(value_of(one[0], bench_figure("ms_mean")), 20.0);
  EXPECT_EQ(value_of(one[0], bench_figure("ape_rmse_m")), 0.5);
  EXPECT_EQ(one[1].sequence, "b");
  EXPECT_FALSE(one[1].metrics.repeats);
  const auto differing = combined({made_cell("a", 1, 30, 0.5), made_cell("a", 2, 10, 0.6)});
  EXPECT_TRUE(differing.at(0).failed());
  BenchCell failed = made_cell("a", 2, 1, 1);
  failed.error = "why";
  EXPECT_EQ(combined({made_cell("a", 1, 30, 0.5), failed}).at(0).error, "why");
}

// They depend on the machine, and on what else it does.
TEST(BenchRepeats, WithABudgetOfTimeFindingsAreMediansToo) {
  std::vector<BenchCell> cells = {made_cell("a", 1, 30, 0.5), made_cell("a", 2, 10, 0.7), made_cell("a", 3, 20, 0.6)};
  for (BenchCell& cell : cells) cell.metrics.budget = BudgetMetrics{40, 1, 0, 0};
  cells[1].kitti->segments = {{1, 2, 100, 0.75, 0.1}};
  cells[2].kitti->segments = {{1, 2, 100, 0.50, 0.1}};
  const BenchCell one = combined(cells).at(0);
  EXPECT_FALSE(one.failed()) << one.error;
  EXPECT_EQ(value_of(one, bench_figure("ms_mean")), 20.0);
  EXPECT_EQ(value_of(one, bench_figure("ape_rmse_m")), 0.6);
  EXPECT_DOUBLE_EQ(one.kitti->t_rel_pct().value(), 50.0);  // for the pooled average
}

TEST(Slurm, ListsAreReadAndWritten) {
  EXPECT_EQ(index_ranges({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
  EXPECT_EQ(index_ranges({3}), "3");
  EXPECT_EQ(index_ranges({}), "");
  const auto tasks =
      parse_queue("12|3|RUNNING|rilo-ab-1000\n13|N/A|PENDING|shell\nslurm_load_jobs error\n|||\n14|0|\n");
  ASSERT_EQ(tasks.size(), 2U);
  EXPECT_EQ(tasks[0].id(), "12_3");
  EXPECT_EQ(tasks[0].state, "RUNNING");
  EXPECT_EQ(tasks[0].name, "rilo-ab-1000");
  EXPECT_EQ(tasks[1].name, "");
}

TEST(Slurm, ATaskThatTheQueueDoesNotListMayStillGoOn) {
  for (const char* state : {"COMPLETED", "CANCELLED by 1000", "TIMEOUT", "OUT_OF_MEMORY", "NODE_FAIL", "UNKNOWN"}) {
    EXPECT_TRUE(is_over(state)) << state;
  }
  for (const char* state : {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "REQUEUED", "SUSPENDED"}) {
    EXPECT_FALSE(is_over(state)) << state;
  }
}

TEST(Slurm, ProgramsAreRunToTheirEnd) {
  EXPECT_EQ(run_program({"sh", "-c", "echo out; echo err >&2; exit 3"}).code, 3);
  EXPECT_EQ(run_program({"sh", "-c", "echo out; echo err >&2"}).out, "out\nerr\n");
  EXPECT_EQ(run_program({"no-such-program-of-rilo"}).code, 127);
}

}  // namespace
}  // namespace rilo
