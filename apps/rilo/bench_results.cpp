#include "bench_results.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "text.hpp"
#include "version.hpp"

namespace rilo::cli {

namespace {

nlohmann::json cell_json(const BenchCell& cell) {
  nlohmann::json figures;
  for (const BenchFigure& figure : bench_figures()) figures[figure.key] = or_null(value_of(cell, figure));
  nlohmann::json json = {{"sequence", cell.sequence},
                         {"configuration", cell.configuration},
                         {"kind", cell.peer ? "peer" : "run"},
                         {"settings", cell.settings},
                         {"figures", figures},
                         {"metrics", cell.metrics}};
  if (cell.failed()) json["error"] = cell.error;
  if (!cell.log.empty()) json["log"] = cell.log;
  return json;
}

nlohmann::json summary_json(const BenchSummary& summary) {
  nlohmann::json means;
  for (std::size_t i = 0; i < summary.means.size(); ++i) means[bench_figures()[i].key] = or_null(summary.means[i]);
  return {{"configuration", summary.configuration},
          {"kind", summary.peer ? "peer" : "run"},
          {"sequences", summary.cells},
          {"failed", summary.failed},
          {"pooled",
           {{"t_rel_pct", or_null(summary.kitti.pooled_t_rel_pct)},
            {"r_rel_deg_per_100m", or_null(summary.kitti.pooled_r_rel_deg_100m)}}},
          {"sequence_mean", means}};
}

BenchSummary summary_of(const std::vector<BenchCell>& cells, const std::string& configuration, bool peer) {
  BenchSummary summary;
  summary.configuration = configuration;
  summary.peer = peer;
  std::vector<KittiError> errors;
  std::vector<std::pair<double, std::size_t>> sums(bench_figures().size());
  for (const BenchCell& cell : cells) {
    if (cell.configuration != configuration || cell.peer != peer) continue;
    ++(cell.failed() ? summary.failed : summary.cells);
    if (cell.failed()) continue;
    if (cell.kitti) errors.push_back(*cell.kitti);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto value = value_of(cell, bench_figures()[i]);
      sums[i].first += value.value_or(0);
      sums[i].second += value ? 1 : 0;
    }
  }
  summary.kitti = kitti_benchmark(errors);
  for (const auto& [sum, count] : sums) {
    summary.means.push_back(count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt);
  }
  return summary;
}

}  // namespace

const std::vector<BenchFigure>& bench_figures() {
  static const std::vector<BenchFigure> kFigures = {
      {"t_rel_pct", "t_rel %", "/evaluation/t_rel_pct", 4},
      {"r_rel_deg_per_100m", "r_rel °/100m", "/evaluation/r_rel_deg_per_100m", 4},
      {"ape_rmse_m", "APE rmse m", "/evaluation/ape_m/rmse", 4},
      {"ape_mean_m", "APE mean m", "/evaluation/ape_m/mean", 4},
      {"ape_std_m", "APE std m", "/evaluation/ape_m/std", 4},
      {"ape_unaligned_rmse_m", "unaligned rmse m", "/evaluation/ape_unaligned_m/rmse", 4},
      {"rpe_frame_rmse_m", "RPE m", "/evaluation/rpe_frame_m/rmse", 4},
      {"rpe_frame_rmse_deg", "RPE °", "/evaluation/rpe_frame_deg/rmse", 4},
      {"ms_mean", "ms mean", "/ms/mean", 1, true},
      {"ms_median", "median", "/ms/median", 1, true},
      {"ms_p95", "p95", "/ms/p95", 1, true},
      {"ms_p99", "p99", "/ms/p99", 1, true},
      {"ms_max", "max", "/ms/max", 1, true},
      {"mean_iterations", "iterations", "/mean_iterations", 2},
      {"selection_rate_pct", "selected %", "/selection_rate_pct", 2},
      {"coarse_rate_pct", "coarse %", "/coarse_rate_pct", 2},
      {"peak_rss_mb", "peak MiB", "/peak_rss_mb", 0, true},
      {"elevation_offset_applied_deg", "own °", "/elevation_offset_applied_deg", 3}};
  return kFigures;
}

const BenchFigure& bench_figure(const std::string& key) {
  const auto& all = bench_figures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const BenchFigure& figure) { return key == figure.key; });
  if (found == all.end()) throw std::logic_error("no figure " + key);
  return *found;
}

std::optional<double> value_of(const BenchCell& cell, const BenchFigure& figure) {
  const nlohmann::json::json_pointer pointer(figure.pointer);
  if (cell.failed() || !cell.metrics.contains(pointer)) return std::nullopt;
  const nlohmann::json& value = cell.metrics.at(pointer);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::vector<BenchSummary> summaries(const std::vector<BenchCell>& cells) {
  std::vector<BenchSummary> result;
  for (const BenchCell& cell : cells) {
    const bool known = std::any_of(result.begin(), result.end(), [&](const BenchSummary& s) {
      return s.configuration == cell.configuration && s.peer == cell.peer;
    });
    if (!known) result.push_back(summary_of(cells, cell.configuration, cell.peer));
  }
  return result;
}

nlohmann::json results_json(const BenchRecord& bench) {
  nlohmann::json json = {{"rilo_bench", 1},
                         {"rilo_version", kVersion},
                         {"command", bench.command_line},
                         {"interrupted", bench.signal != 0},
                         {"cells_planned", bench.planned},
                         {"cells_run", bench.run},
                         {"cells", nlohmann::json::array()},
                         {"summary", nlohmann::json::array()}};
  for (const BenchCell& cell : bench.cells) json["cells"].push_back(cell_json(cell));
  for (const BenchSummary& summary : summaries(bench.cells)) json["summary"].push_back(summary_json(summary));
  return json;
}

}  // namespace rilo::cli
