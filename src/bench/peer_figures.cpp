#include "bench/peer_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "bench/figures.hpp"
#include "results/csv_file.hpp"

namespace rilo {

namespace {

constexpr CsvKind kPeerFigures{"figures of peers (columns drive, peer, t_rel_pct)", "See docs/bench.md",
                               "Check the path"};

struct Alias {
  const char* column;
  const char* figure;
};
constexpr std::array<Alias, 3> kAliases = {
    {{"r_rel_deg_100m", "r_rel_deg_per_100m"}, {"mean_ms", "ms_mean"}, {"median_ms", "ms_median"}}};

void read_figure(const CsvFile& line, const char* column, const BenchFigure& figure, BenchCell& cell) {
  if (!line.has(column) || line.cell(column).empty()) return;
  const auto value = line.number<double>(column);
  if (std::isfinite(value)) figure.place(cell.metrics) = value;
}

BenchCell cell_of(const CsvFile& line, const std::filesystem::path& file) {
  BenchCell cell{line.cell("drive"), line.cell("peer"), true, {file.string()}, {}, {}, {}, kSuccess};
  for (const BenchFigure& figure : bench_figures()) read_figure(line, figure.key, figure, cell);
  for (const Alias& alias : kAliases) read_figure(line, alias.column, bench_figure(alias.figure), cell);
  if (line.has("pose_instant")) cell.metrics.evaluation.truth_instant = line.cell("pose_instant");
  return cell;
}

}  // namespace

std::vector<BenchCell> read_peer_figures(const std::filesystem::path& file) {
  std::vector<BenchCell> cells;
  std::set<std::pair<std::string, std::string>> seen;
  CsvFile line(file, kPeerFigures);
  for (const char* needed : {"drive", "peer", "t_rel_pct"}) line.need(needed);
  while (line.next()) {
    if (line.cell("peer").empty()) line.refuse("peer", "the name of a peer");
    cells.push_back(cell_of(line, file));
    if (!seen.emplace(cells.back().sequence, cells.back().configuration).second) {
      line.refuse("peer", "each peer once on a drive");
    }
  }
  return cells;
}

void add_peer_figures(const std::vector<BenchCell>& figures, const std::string& sequence, bool whole,
                      std::vector<StoredCell>& cells) {
  for (const BenchCell& given : figures) {
    if (given.sequence != sequence) continue;
    const auto same = std::find_if(cells.begin(), cells.end(), [&](const StoredCell& stored) {
      return stored.cell.peer && stored.cell.sequence == sequence && stored.cell.configuration == given.configuration;
    });
    if (same == cells.end()) {
      if (whole) cells.push_back({given, "", 1, ""});
    } else if (!same->cell.failed() && given.metrics.timed()) {
      same->cell.metrics.ms = given.metrics.ms;
    }
  }
}

}  // namespace rilo
