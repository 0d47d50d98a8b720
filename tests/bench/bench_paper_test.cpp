// Which runs the data sets mean, and our columns beside the paper's.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/paper.hpp"
#include "io/io_test_util.hpp"

namespace rilo {
namespace {

namespace fs = std::filesystem;
using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;

BenchConfiguration configuration() { return {"rilo", {}, {}}; }

BenchCell paper_cell(const std::string& sequence, const std::string& name, double rmse) {
  BenchCell made;
  made.sequence = sequence;
  made.configuration = name;
  made.metrics.evaluation.ape_m = {rmse, rmse / 2, rmse / 4, {}, {}};
  made.metrics.ms.mean = 12.34;
  return made;
}

const std::vector<std::string>& row_of(const TextTable& table, const std::string& name) {
  const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const auto& r) { return r[0] == name; });
  if (row == table.rows.end()) throw std::runtime_error("no row " + name);
  return *row;
}

TEST(KittiJobs, BothProtocolsWithoutOwnEstimateAndTheEstimate) {
  const TempDir root;
  fs::create_directories(root / "sequences/07/velodyne");
  fs::create_directories(root / "sequences/12/velodyne");  // has no truth, is not in the paper
  fs::create_directories(root / "sequences/03");           // no sweeps
  const auto jobs = kitti_jobs(root.path(), configuration());
  ASSERT_EQ(jobs.size(), 3U);
  EXPECT_EQ(jobs[0].configuration.name, "rilo, 0°");
  EXPECT_EQ(jobs[0].sequence.elevation_correction_deg, 0.0);
  EXPECT_FALSE(jobs[0].configuration.config.elevation.enabled);
  EXPECT_EQ(jobs[1].configuration.name, "rilo, 0.205°");
  EXPECT_EQ(jobs[1].sequence.elevation_correction_deg, 0.205);
  EXPECT_FALSE(jobs[1].configuration.config.elevation.enabled);
  EXPECT_THAT(jobs[1].configuration.settings, ElementsAre("elevation.enabled=false"));
  EXPECT_EQ(jobs[2].configuration.name, "rilo, own estimate");
  EXPECT_EQ(jobs[2].sequence.elevation_correction_deg, 0.0);
  EXPECT_TRUE(jobs[2].configuration.config.elevation.enabled);
  EXPECT_EQ(jobs[2].sequence.path, root / "sequences/07");
}

TEST(KittiJobs, AnEstimateThatIsSwitchedOffIsNotRun) {
  const TempDir root;
  fs::create_directories(root / "sequences/00/velodyne");
  BenchConfiguration off = configuration();
  off.config.elevation.enabled = false;
  EXPECT_EQ(kitti_jobs(root.path(), off).size(), 2U);
}

TEST(KittiJobs, NothingThere) {
  const TempDir root;
  try {
    kitti_jobs(root.path(), configuration());
    FAIL();
  } catch (const RunError& error) {
    EXPECT_EQ(error.kind(), RunErrorKind::kBadData);
    EXPECT_THAT(error.what(), HasSubstr("sequences/00/velodyne"));
  }
}

TEST(KittiTables, OursBesideThePapersAndAveragesOfTheSameSequences) {
  const auto tables = kitti_tables({paper_cell("00", "p, 0°", 4), paper_cell("04", "p, 0°", 2),
                                    paper_cell("00", "p, own estimate", 1), paper_cell("04", "p, own estimate", 3)});
  ASSERT_EQ(tables.size(), 2U);
  const TextTable& first = tables[0].table;
  ASSERT_EQ(first.header.size(), 1U + 3 * 7);
  EXPECT_EQ(first.header[13], "paper RMSE");
  EXPECT_EQ(first.header[16], "p, 0° RMSE");
  const auto& zero = row_of(first, "00");
  EXPECT_EQ(zero[13], "3.23");
  EXPECT_EQ(zero[16], "4.00");
  EXPECT_EQ(zero[17], "2.00");
  EXPECT_EQ(zero[18], "1.00");
  EXPECT_EQ(zero[19], "1.00");
  EXPECT_EQ(row_of(first, "01")[16], "-");
  EXPECT_EQ(row_of(first, "Avg")[13], "3.08");
  EXPECT_EQ(row_of(first, "Avg")[16], "-");  // of all eleven
  const auto& common = row_of(first, "Avg of our 2");
  EXPECT_EQ(common[13], "1.75");  // (3.23 + 0.26) / 2, half to even of 1.745 in binary
  EXPECT_EQ(common[16], "3.00");
  EXPECT_EQ(common[19], "2.00");
  const TextTable& second = tables[1].table;
  EXPECT_EQ(row_of(second, "paper")[1], "18.0");
  EXPECT_EQ(row_of(second, "p, 0°")[1], "12.3");
  EXPECT_EQ(row_of(second, "p, 0°")[2], "-");
}

TEST(M2dgrJobs, FoldersBagsAndTruth) {
  const TempDir root;
  fs::create_directories(root / "hall_01");
  root.write("hall_01.txt", "");
  root.write("hall_01.bag", "");  // the folder is taken
  root.write("door_01.bag", "");  // read as it is
  fs::create_directories(root / "street_01");
  root.write("street_01.txt", "");  // not in the paper, with truth
  fs::create_directories(root / "notes");
  const auto jobs = m2dgr_jobs(root.path(), configuration());
  ASSERT_EQ(jobs.size(), 3U);
  EXPECT_EQ(jobs[0].sequence.path, root / "door_01.bag");
  EXPECT_EQ(jobs[1].sequence.path, root / "hall_01");
  EXPECT_EQ(jobs[1].sequence.ground_truth, root / "hall_01.txt");
  EXPECT_EQ(jobs[2].sequence.name, "street_01");
}

TEST(M2dgrJobs, NothingThere) {
  const TempDir root;
  EXPECT_THROW(m2dgr_jobs(root.path(), configuration()), RunError);
  EXPECT_THROW(m2dgr_jobs(root / "none", configuration()), RunError);
}

TEST(M2dgrTables, NamesOfTheDataSetAreThoseOfThePaper) {
  const auto tables = m2dgr_tables({paper_cell("hall_01", "rilo", 0.5), paper_cell("Lift_01", "rilo", 0.1)});
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_THAT(row_of(tables[0].table, "paper"),
              ElementsAre("paper", "0.29", "0.25", "0.39", "0.47", "0.28", "0.15", "0.31", "0.22"));
  EXPECT_THAT(row_of(tables[0].table, "rilo"), ElementsAre("rilo", "0.50", "-", "-", "-", "-", "0.10", "-", "0.30"));
}

}  // namespace
}  // namespace rilo
