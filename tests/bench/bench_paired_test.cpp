// Configurations beside peers: cells made by hand, and figures from a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/paired.hpp"
#include "bench/peer_figures.hpp"
#include "io/io_test_util.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;

BenchCell paired_cell(const std::string& sequence, const std::string& name, double t_rel_pct,
                      const std::string& group = "") {
  BenchCell made;
  made.sequence = sequence;
  made.configuration = name;
  made.group = group;
  made.metrics.evaluation.t_rel_pct = t_rel_pct;
  return made;
}

BenchCell peer(const std::string& sequence, const std::string& name, double t_rel_pct) {
  BenchCell made = paired_cell(sequence, name, t_rel_pct);
  made.peer = true;
  return made;
}

BenchCell failed(BenchCell cell) {
  cell.error = "failed";
  return cell;
}

// Ours 1, 2 and lost; A 2, 1 and 4; B 4 on the first, not to be read on the third, not given on the second.
std::vector<BenchCell> three_drives() {
  return {paired_cell("p01", "ours", 1, "odd"),
          peer("p01", "A", 2),
          peer("p01", "B", 4),
          paired_cell("p02", "ours", 2, "even"),
          peer("p02", "A", 1),
          paired_cell("p03", "ours", 40, "odd"),
          peer("p03", "A", 4),
          failed(peer("p03", "B", 1))};
}

const PairedComparison& against(const std::vector<BenchComparison>& all, const std::string& peer,
                                const std::string& group) {
  for (const BenchComparison& c : all) {
    if (c.peer == peer && c.group == group) return c.result;
  }
  throw std::runtime_error("no comparison");
}

TEST(BenchPaired, EveryPeerAndTheBestOfEachDriveByGroup) {
  const auto all = bench_comparisons(three_drives());
  ASSERT_EQ(all.size(), 9U);  // three groups, three peers
  const PairedComparison& best = against(all, kBestPeer, "all");
  EXPECT_EQ(best.drives, 3U);
  EXPECT_NEAR(best.mean_ratio.value(), 1.0, 1e-12);                    // 1/2 and 2
  EXPECT_NEAR(best.mean_ratio_all.value(), 2.1544346900318838, 1e-9);  // cube root of 10
  EXPECT_THAT(best.lost_by_us, ElementsAre("p03"));
  EXPECT_EQ(best.worst_drive, "p03");
  EXPECT_EQ(against(all, kBestPeer, "odd").drives, 2U);
  EXPECT_NEAR(against(all, kBestPeer, "even").mean_ratio.value(), 2.0, 1e-12);
  const PairedComparison& b = against(all, "B", "all");
  EXPECT_EQ(b.drives, 1U);  // what could not be read says nothing
  EXPECT_TRUE(b.lost_by_them.empty());
  EXPECT_EQ(b.ahead, 1U);
  EXPECT_EQ(b.behind, 0U);
}

TEST(BenchPaired, ADriveThatBothLostCountsForNeither) {
  BenchCell lost = peer("a", "B", 0);
  lost.metrics.evaluation.t_rel_pct.reset();
  const auto all = bench_comparisons({paired_cell("a", "ours", 40), lost});
  const PairedComparison& b = against(all, "B", "all");
  EXPECT_THAT(b.lost_by_them, ElementsAre("a"));
  EXPECT_EQ(b.ahead, 0U);
  EXPECT_EQ(b.behind, 0U);
}

TEST(BenchPaired, APeerThatFailedEverywhereIsComparedNowhere) {
  const std::vector<BenchCell> cells = {paired_cell("a", "ours", 1), failed(peer("a", "B", 1))};
  EXPECT_EQ(against(bench_comparisons(cells), "B", "all").drives, 0U);
  EXPECT_EQ(against(bench_comparisons(cells), kBestPeer, "all").ahead, 0U);
  EXPECT_THAT(paired_tables(cells).back().note, HasSubstr("\nnot compared with B, which failed: a"));
}

TEST(BenchPaired, TablesNameWhatIsLost) {
  const auto tables = paired_tables(three_drives());
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_THAT(tables[0].table.rows[0], ElementsAre("p01", "odd", "A", "2.0000", "0.500"));
  EXPECT_THAT(tables[0].table.rows[2], ElementsAre("p03", "odd", "A", "4.0000", "10.000 lost"));
  EXPECT_THAT(tables[1].table.rows[0],
              ElementsAre("ours", "best peer", "all", "3", "1.000", "2.154", "10.00", "p03", "1", "2", "1", "1", "0"));
  EXPECT_THAT(tables[1].note, HasSubstr("\nlost by ours: p03"));
  EXPECT_THAT(tables[1].note, HasSubstr("\nnot compared with B, which failed: p03"));
  EXPECT_TRUE(paired_tables({paired_cell("a", "ours", 1)}).empty());
  EXPECT_TRUE(paired_csv({paired_cell("a", "ours", 1)}).rows.empty());
  const TextTable csv = paired_csv(three_drives());
  EXPECT_EQ(csv.rows.size(), 9U);
  EXPECT_EQ(csv.rows[0].size(), csv.header.size());
}

TEST(PeerFigures, AreReadByTheNamesOfTheColumns) {
  const TempDir folder;
  const auto cells = read_peer_figures(folder.write("peers.csv",
                                                    "drive,peer,t_rel_pct,r_rel_deg_100m,ape_rmse_m,mean_ms,x\n"
                                                    "a,K,0.5,0.25,1.5,20,?\n\nb,K,nan,,,,\n"));
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_TRUE(cells[0].peer);
  EXPECT_EQ(value_of(cells[0], bench_figure("t_rel_pct")), 0.5);
  EXPECT_EQ(value_of(cells[0], bench_figure("r_rel_deg_per_100m")), 0.25);
  EXPECT_EQ(value_of(cells[0], bench_figure("ape_rmse_m")), 1.5);
  EXPECT_EQ(value_of(cells[0], bench_figure("ms_mean")), 20.0);
  EXPECT_FALSE(value_of(cells[1], bench_figure("t_rel_pct")));
  std::vector<StoredCell> stored = {{peer("a", "K", 3), "", 1, ""}};
  add_peer_figures(cells, "a", true, stored);
  ASSERT_EQ(stored.size(), 1U);  // its poses count; the times are added
  EXPECT_EQ(value_of(stored[0].cell, bench_figure("t_rel_pct")), 3.0);
  EXPECT_EQ(value_of(stored[0].cell, bench_figure("ms_mean")), 20.0);
  add_peer_figures(cells, "b", false, stored);
  ASSERT_EQ(stored.size(), 1U);  // figures of whole drives, but a part was run
  add_peer_figures(cells, "b", true, stored);
  ASSERT_EQ(stored.size(), 2U);
  EXPECT_EQ(stored[1].cell.configuration, "K");
}

TEST(PeerFigures, AnythingElseIsRefused) {
  const TempDir folder;
  const auto refused = [&](const std::string& text, std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("peers.csv", text);
    test::expect_io_error([&] { read_peer_figures(file); }, parts);
  };
  refused("", {"peers.csv", "no file that can be read"});
  refused("drive,peer\n", {"no column t_rel_pct"});
  refused("drive,peer,t_rel_pct\na,K\n", {"line 2", "2 values"});
  refused("drive,peer,t_rel_pct\na,K,much\n", {"line 2, column t_rel_pct", "much", "a number"});
  refused("drive,peer,t_rel_pct\na,,1\n", {"column peer"});
  refused("drive,peer,t_rel_pct\na,K,1\na,K,2\n", {"line 3", "each peer once"});
}

}  // namespace
}  // namespace rilo
