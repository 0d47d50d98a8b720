#include "bench/tables.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "console/text.hpp"

namespace rilo {

namespace {

const std::vector<std::string> kAccuracy = {"t_rel_pct",  "r_rel_deg_per_100m",   "ape_rmse_m",
                                            "ape_mean_m", "ape_unaligned_rmse_m", "rpe_frame_rmse_m"};
const std::vector<std::string> kEffort = {
    "ms_mean",         "ms_median",          "ms_p95",          "ms_p99",     "ms_max",
    "mean_iterations", "selection_rate_pct", "coarse_rate_pct", "peak_rss_mb"};

bool is_shown(const BenchFigure& figure, MeasuredColumns measured) {
  return measured == MeasuredColumns::kWith || !figure.measured;
}

std::vector<std::string> wanted(std::vector<std::string> keys, MeasuredColumns measured) {
  std::erase_if(keys, [&](const std::string& key) { return !is_shown(bench_figure(key), measured); });
  return keys;
}

void add_titles(TextTable& table, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) table.header.emplace_back(bench_figure(key).title);
}

void add_values(std::vector<std::string>& row, const BenchCell& cell, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    const BenchFigure& figure = bench_figure(key);
    row.push_back(shown(value_of(cell, figure), figure.digits));
  }
}

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

std::string or_dash(const MaybeCount& count) { return count ? std::to_string(*count) : "-"; }

std::string or_dash(const MaybeNumber& value) { return value ? nlohmann::json(*value).dump() : "-"; }

// "ok 11, initialising 1"; what did not occur is omitted.
std::string statuses(const RunMetrics& metrics) {
  std::string text;
  for (const auto& [name, count] : metrics.status) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count);
  }
  return metrics.status.empty() ? "-" : text;
}

TitledTable accuracy(const std::vector<BenchCell>& cells) {
  TitledTable result{"Accuracy", {}, ""};
  result.table.left = 2;
  result.table.header = {"sequence", "configuration", "poses"};
  add_titles(result.table, kAccuracy);
  result.table.header.insert(result.table.header.end(), {"instant", "truth at", "given °", "own °"});
  for (const BenchCell& cell : cells) {
    std::vector<std::string> row = {cell.sequence, cell.configuration,
                                    cell.failed() ? "failed" : or_dash(cell.metrics.evaluation.poses)};
    add_values(row, cell, kAccuracy);
    row.push_back(or_dash(cell.metrics.pose_instant));
    row.push_back(or_dash(cell.metrics.evaluation.truth_instant));
    row.push_back(or_dash(cell.metrics.elevation_correction_deg));
    add_values(row, cell, {"elevation_offset_applied_deg"});
    result.table.rows.push_back(row);
  }
  result.note =
      "APE after SE(3) alignment, unaligned with the first poses made equal; RPE per sweep, rmse; given °: added to "
      "the points' elevation angles as given; own °: added on top of it, estimated by Rilo, after the last sweep.";
  return result;
}

TitledTable effort(const std::vector<BenchCell>& cells, MeasuredColumns measured) {
  const std::vector<std::string> keys = wanted(kEffort, measured);
  TitledTable result{"Effort", {}, ""};
  result.table.left = 2;
  result.table.header = {"sequence", "configuration", "sweeps"};
  add_titles(result.table, keys);
  result.table.header.emplace_back("status");
  for (const BenchCell& cell : cells) {
    // Of a peer nothing but times can be known.
    if (cell.peer && !(measured == MeasuredColumns::kWith && cell.metrics.timed())) continue;
    std::vector<std::string> row = {cell.sequence, cell.configuration,
                                    cell.failed() ? "failed" : or_dash(cell.metrics.frames)};
    add_values(row, cell, keys);
    row.push_back(statuses(cell.metrics));
    result.table.rows.push_back(row);
  }
  result.note = measured == MeasuredColumns::kWith ? "Milliseconds per sweep without reading. " : "";
  result.note += "selected: sweeps that began with the coarse result; coarse: that ran the coarse stage.";
  return result;
}

TitledTable averages(const std::vector<BenchCell>& cells, MeasuredColumns measured) {
  TitledTable result{"Averages of the configurations", {}, ""};
  result.table.header = {"configuration", "sequences", "t_rel % pooled", "r_rel pooled"};
  std::vector<std::string> keys = kAccuracy;
  keys.insert(keys.end(), {"ms_mean", "mean_iterations", "selection_rate_pct", "coarse_rate_pct"});
  keys = wanted(keys, measured);
  add_titles(result.table, keys);
  for (const BenchSummary& summary : summaries(cells)) {
    const std::size_t all = summary.cells + summary.failed;
    std::vector<std::string> row = {
        summary.configuration, summary.failed == 0 ? std::to_string(all) : fmt::format("{} of {}", summary.cells, all),
        shown(summary.kitti.pooled_t_rel_pct, 4), shown(summary.kitti.pooled_r_rel_deg_100m, 4)};
    for (const std::string& key : keys) {
      const BenchFigure& figure = bench_figure(key);
      row.push_back(shown(summary.means[static_cast<std::size_t>(&figure - bench_figures().data())], figure.digits));
    }
    result.table.rows.push_back(row);
  }
  result.note =
      "Pooled: over all segments of all sequences (KITTI devkit). All others: mean of the sequences' figures.";
  return result;
}

// One row per sequence, one column per configuration.
TitledTable by_sequence(const std::vector<BenchCell>& cells, const std::vector<BenchSummary>& columns,
                        const std::string& key) {
  const BenchFigure& figure = bench_figure(key);
  TitledTable result{fmt::format("{} of each sequence", figure.title), {}, ""};
  result.table.header = {"sequence"};
  for (const BenchSummary& column : columns) result.table.header.push_back(column.configuration);
  for (const BenchCell& cell : cells) {
    auto& rows = result.table.rows;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r[0] == cell.sequence; });
    if (row == rows.end()) {
      row = rows.insert(rows.end(), std::vector<std::string>(columns.size() + 1));
      row->front() = cell.sequence;
    }
    const auto column = std::find_if(columns.begin(), columns.end(), [&](const BenchSummary& c) {
      return c.configuration == cell.configuration && c.peer == cell.peer;
    });
    (*row)[static_cast<std::size_t>(column - columns.begin()) + 1] =
        cell.failed() ? "failed" : shown(value_of(cell, figure), figure.digits);
  }
  return result;
}

std::string failures(const std::vector<BenchCell>& cells) {
  std::string text;
  for (const BenchCell& cell : cells) {
    if (cell.failed()) {
      text += fmt::format("failed: {} × {}: {}{}\n", cell.sequence, cell.configuration, cell.error,
                          cell.log.empty() ? "" : " (log: " + cell.log + ")");
    }
  }
  return text;
}

using Key = std::pair<std::string, std::string>;

std::map<Key, const nlohmann::json*> cells_of(const nlohmann::json& baseline) {
  std::map<Key, const nlohmann::json*> cells;
  for (const auto& cell : baseline["cells"]) cells[{cell["sequence"], cell["configuration"]}] = &cell["figures"];
  return cells;
}

std::string difference(const std::optional<double>& now, const nlohmann::json& figures, const BenchFigure& figure) {
  const auto old = figures.find(figure.key);
  if (!now || old == figures.end() || !old->is_number()) return "-";
  return fmt::format("{:+.{}f}", *now - old->get<double>(), figure.digits);
}

std::string name_of(const Key& key) { return key.first + " × " + key.second; }

}  // namespace

std::string exact(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string shown(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::vector<TitledTable> bench_tables(const std::vector<BenchCell>& cells, MeasuredColumns measured) {
  std::vector<TitledTable> tables = {accuracy(cells), effort(cells, measured), averages(cells, measured)};
  const std::string failed = failures(cells);
  if (!failed.empty()) tables.back().note += "\n" + failed.substr(0, failed.size() - 1);
  const std::vector<BenchSummary> columns = summaries(cells);
  if (columns.size() > 1) {
    tables.push_back(by_sequence(cells, columns, "t_rel_pct"));
    tables.push_back(by_sequence(cells, columns, "ape_rmse_m"));
  }
  return tables;
}

TitledTable baseline_table(const std::vector<BenchCell>& cells, const nlohmann::json& baseline,
                           const std::filesystem::path& file) {
  TitledTable result{"Difference to " + valid_utf8(file.string()), {}, "New minus old."};
  result.table.left = 2;
  result.table.header = {"sequence", "configuration"};
  for (const BenchFigure& figure : bench_figures()) result.table.header.emplace_back(figure.title);
  auto old = cells_of(baseline);
  std::string alone;
  for (const BenchCell& cell : cells) {
    const Key key{cell.sequence, cell.configuration};
    const auto found = old.find(key);
    if (found == old.end()) {
      alone += "\nnot in the baseline: " + name_of(key);
      continue;
    }
    std::vector<std::string> row = {cell.sequence, cell.configuration};
    for (const BenchFigure& figure : bench_figures()) {
      row.push_back(difference(value_of(cell, figure), *found->second, figure));
    }
    result.table.rows.push_back(row);
    old.erase(found);
  }
  for (const auto& [key, figures] : old) alone += "\nonly in the baseline: " + name_of(key);
  result.note += alone;
  return result;
}

TextTable bench_csv(const std::vector<BenchCell>& cells, MeasuredColumns measured) {
  TextTable table;
  table.header = {"row", "sequence", "configuration", "kind"};
  for (const BenchFigure& figure : bench_figures()) {
    if (is_shown(figure, measured)) table.header.emplace_back(figure.key);
  }
  table.header.insert(table.header.end(), {"frames", "status", "pose_instant", "truth_instant", "point_times",
                                           "elevation_correction_deg", "error"});
  for (const BenchCell& cell : cells) {
    std::vector<std::string> row = {"cell", cell.sequence, cell.configuration, cell.peer ? "peer" : "run"};
    for (const BenchFigure& figure : bench_figures()) {
      if (is_shown(figure, measured)) row.push_back(exact(value_of(cell, figure)));
    }
    row.push_back(or_dash(cell.metrics.frames));
    row.push_back(statuses(cell.metrics));
    for (const std::string& text :
         {cell.metrics.pose_instant, cell.metrics.evaluation.truth_instant, cell.metrics.point_times}) {
      row.push_back(or_dash(text));
    }
    row.push_back(or_dash(cell.metrics.elevation_correction_deg));
    row.push_back(cell.error);
    table.rows.push_back(row);
  }
  for (const BenchSummary& summary : summaries(cells)) {
    const std::string kind = summary.peer ? "peer" : "run";
    table.rows.push_back({"pooled", "", summary.configuration, kind, exact(summary.kitti.pooled_t_rel_pct),
                          exact(summary.kitti.pooled_r_rel_deg_100m)});
    std::vector<std::string> row = {"mean", "", summary.configuration, kind};
    for (std::size_t i = 0; i < summary.means.size(); ++i) {
      if (is_shown(bench_figures()[i], measured)) row.push_back(exact(summary.means[i]));
    }
    table.rows.push_back(row);
  }
  return table;
}

std::string plain_text(const std::vector<TitledTable>& tables) {
  std::string text;
  for (const TitledTable& t : tables) {
    text += (text.empty() ? "" : "\n") + t.title + "\n" + t.table.plain() + (t.note.empty() ? "" : t.note + "\n");
  }
  return text;
}

std::string markdown_text(const std::vector<TitledTable>& tables) {
  std::string text;
  for (const TitledTable& t : tables) {
    text += (text.empty() ? "## " : "\n## ") + t.title + "\n\n" + t.table.markdown();
    if (!t.note.empty()) {
      text += "\n";
      for (const char c : t.note) text += c == '\n' ? std::string("\n\n") : std::string(1, c);
      text += "\n";
    }
  }
  return text;
}

}  // namespace rilo
