#include "bench/paired.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rilo {

namespace {

constexpr const char* kAll = "all";

std::optional<double> t_rel(const BenchCell& cell) {
  static const BenchFigure& figure = bench_figure("t_rel_pct");
  return value_of(cell, figure);
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

// Names of configurations, or of peers.
std::vector<std::string> names_of(const std::vector<BenchCell>& cells, bool peers) {
  std::vector<std::string> names;
  for (const BenchCell& cell : cells) {
    if (cell.peer == peers) add_once(names, cell.configuration);
  }
  return names;
}

std::vector<std::string> groups_of(const std::vector<BenchCell>& cells) {
  std::vector<std::string> groups = {kAll};
  for (const BenchCell& cell : cells) {
    if (!cell.peer && !cell.group.empty()) add_once(groups, cell.group);
  }
  return groups;
}

// The one with the least t_rel; without any, one that has none. Null where no peer was given or could be read.
const BenchCell* best_peer(const std::vector<BenchCell>& cells, const std::string& sequence) {
  const BenchCell* best = nullptr;
  for (const BenchCell& cell : cells) {
    if (!cell.peer || cell.failed() || cell.sequence != sequence) continue;
    const auto value = t_rel(cell);
    if (best == nullptr || (value && (!t_rel(*best) || *value < *t_rel(*best)))) best = &cell;
  }
  return best;
}

// Poses that could not be read say nothing about the program that they are of.
const BenchCell* peer_on(const std::vector<BenchCell>& cells, const std::string& sequence, const std::string& peer) {
  if (peer == kBestPeer) return best_peer(cells, sequence);
  const auto found = std::find_if(cells.begin(), cells.end(), [&](const BenchCell& cell) {
    return cell.peer && !cell.failed() && cell.sequence == sequence && cell.configuration == peer;
  });
  return found == cells.end() ? nullptr : &*found;
}

std::vector<PairedFigure> pairs_of(const std::vector<BenchCell>& cells, const BenchComparison& wanted) {
  std::vector<PairedFigure> pairs;
  for (const BenchCell& cell : cells) {
    if (cell.peer || cell.configuration != wanted.configuration) continue;
    if (wanted.group != kAll && cell.group != wanted.group) continue;
    if (const BenchCell* peer = peer_on(cells, cell.sequence, wanted.peer)) {
      pairs.push_back({cell.sequence, t_rel(cell), t_rel(*peer)});
    }
  }
  return pairs;
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

// "\nnot compared with …", a line for each peer of which some poses could not be read.
std::string not_compared(const std::vector<BenchCell>& cells) {
  std::string lines;
  for (const std::string& peer : names_of(cells, true)) {
    std::vector<std::string> sequences;
    for (const BenchCell& cell : cells) {
      if (cell.peer && cell.failed() && cell.configuration == peer) add_once(sequences, cell.sequence);
    }
    if (!sequences.empty()) lines += fmt::format("\nnot compared with {}, which failed: {}", peer, listed(sequences));
  }
  return lines;
}

TitledTable comparison_table(const std::vector<BenchCell>& cells, const std::vector<BenchComparison>& comparisons) {
  TitledTable result{"t_rel over that of the peers, drive by drive", {}, ""};
  result.table.left = 3;
  result.table.header = {"configuration", "peer",  "drives of", "drives",    "mean ratio", "with lost",   "worst",
                         "worst drive",   "ahead", "behind",    "sign test", "lost by it", "lost by peer"};
  std::vector<std::string> lost;
  for (const BenchComparison& c : comparisons) {
    const PairedComparison& r = c.result;
    result.table.rows.push_back({c.configuration, c.peer, c.group, std::to_string(r.drives), shown(r.mean_ratio, 3),
                                 shown(r.mean_ratio_all, 3), shown(r.worst_ratio, 2), r.worst_drive,
                                 std::to_string(r.ahead), std::to_string(r.behind),
                                 fmt::format("{:.2g}", r.sign_test_p), std::to_string(r.lost_by_us.size()),
                                 std::to_string(r.lost_by_them.size())});
    if (c.group != kAll) continue;
    if (!r.lost_by_us.empty()) add_once(lost, fmt::format("\nlost by {}: {}", c.configuration, listed(r.lost_by_us)));
    if (!r.lost_by_them.empty()) add_once(lost, fmt::format("\nlost by {}: {}", c.peer, listed(r.lost_by_them)));
  }
  result.note = fmt::format(
      "Ratios below 1: the configuration drifts less. mean ratio: geometric, over the drives that neither lost; with "
      "lost: over all that both have a figure of. Lost: t_rel above {} % or none; that drive counts for the other. "
      "sign test: p of ahead and behind, two-sided, exact. best peer: the best one of each drive, chosen afterwards.",
      kLostAbovePct);
  for (const std::string& line : lost) result.note += line;
  result.note += not_compared(cells);
  return result;
}

std::string ratio_shown(const BenchCell& cell, const std::optional<double>& peer) {
  const auto ours = t_rel(cell);
  if (cell.failed()) return "failed";
  if (!ours || !peer || *peer <= 0.0) return "-";
  return fmt::format("{:.3f}{}", *ours / *peer, *ours > kLostAbovePct ? " lost" : "");
}

TitledTable ratio_table(const std::vector<BenchCell>& cells) {
  TitledTable result{"t_rel over that of the best peer, of each sequence", {}, ""};
  const std::vector<std::string> configurations = names_of(cells, false);
  result.table.header = {"sequence", "group", "best peer", "its t_rel %"};
  result.table.left = 3;
  result.table.header.insert(result.table.header.end(), configurations.begin(), configurations.end());
  for (const BenchCell& cell : cells) {
    const BenchCell* best = cell.peer ? nullptr : best_peer(cells, cell.sequence);
    if (best == nullptr) continue;
    auto& rows = result.table.rows;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r[0] == cell.sequence; });
    if (row == rows.end()) {
      row = rows.insert(rows.end(), {cell.sequence, cell.group, best->configuration, shown(t_rel(*best), 4)});
      row->resize(result.table.header.size(), "-");
    }
    const auto place = std::find(configurations.begin(), configurations.end(), cell.configuration);
    (*row)[static_cast<std::size_t>(place - configurations.begin()) + 4] = ratio_shown(cell, t_rel(*best));
  }
  return result;
}

}  // namespace

std::vector<BenchComparison> bench_comparisons(const std::vector<BenchCell>& cells) {
  std::vector<std::string> peers = names_of(cells, true);
  if (peers.empty()) return {};
  peers.insert(peers.begin(), kBestPeer);
  std::vector<BenchComparison> result;
  for (const std::string& configuration : names_of(cells, false)) {
    for (const std::string& group : groups_of(cells)) {
      for (const std::string& peer : peers) {
        BenchComparison comparison{configuration, peer, group, {}};
        comparison.result = compare_pairs(pairs_of(cells, comparison), kLostAbovePct);
        result.push_back(comparison);
      }
    }
  }
  return result;
}

std::vector<TitledTable> paired_tables(const std::vector<BenchCell>& cells) {
  const auto comparisons = bench_comparisons(cells);
  if (comparisons.empty()) return {};
  return {ratio_table(cells), comparison_table(cells, comparisons)};
}

TextTable paired_csv(const std::vector<BenchCell>& cells) {
  TextTable table;
  table.header = {"configuration",        "peer",        "group",       "drives", "mean_ratio",
                  "mean_ratio_with_lost", "worst_ratio", "worst_drive", "ahead",  "behind",
                  "sign_test_p",          "lost",        "lost_by_peer"};
  for (const BenchComparison& c : bench_comparisons(cells)) {
    const PairedComparison& r = c.result;
    table.rows.push_back(
        {c.configuration, c.peer, c.group, std::to_string(r.drives), exact(r.mean_ratio), exact(r.mean_ratio_all),
         exact(r.worst_ratio), r.worst_drive, std::to_string(r.ahead), std::to_string(r.behind), exact(r.sign_test_p),
         fmt::format("{}", fmt::join(r.lost_by_us, " ")), fmt::format("{}", fmt::join(r.lost_by_them, " "))});
  }
  return table;
}

}  // namespace rilo
