#include "bench/figures.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "bench/cell_file.hpp"
#include "console/text.hpp"
#include "console/version.hpp"
#include "evaluation/percentile.hpp"
#include "results/evaluation_output.hpp"

namespace rilo {

namespace {

// Follows pointers to members.
template <auto First, auto... Rest>
auto& member(auto& object) {
  if constexpr (sizeof...(Rest) == 0) {
    return object.*First;
  } else {
    return member<Rest...>(object.*First);
  }
}

template <auto... Path>
BenchFigure figure(const char* key, const char* title, int digits, bool measured = false) {
  return {key,
          title,
          digits,
          measured,
          [](const RunMetrics& metrics) -> const MaybeNumber& { return member<Path...>(metrics); },
          [](RunMetrics& metrics) -> MaybeNumber& { return member<Path...>(metrics); }};
}

nlohmann::json cell_json(const BenchCell& cell) {
  nlohmann::json figures;
  for (const BenchFigure& figure : bench_figures()) figures[figure.key] = or_null(value_of(cell, figure));
  nlohmann::json json = {{"sequence", cell.sequence},
                         {"configuration", cell.configuration},
                         {"kind", cell.peer ? "peer" : "run"},
                         {"settings", cell.settings},
                         {"figures", figures},
                         {"metrics", metrics_json(cell)}};
  if (cell.failed()) json["error"] = cell.error;
  if (!cell.log.empty()) json["log"] = cell.log;
  if (!cell.group.empty()) json["group"] = cell.group;
  return json;
}

nlohmann::json summary_json(const BenchSummary& summary) {
  nlohmann::json means;
  for (std::size_t i = 0; i < summary.means.size(); ++i) means[bench_figures()[i].key] = or_null(summary.means[i]);
  return {{"configuration", summary.configuration},
          {"kind", summary.peer ? "peer" : "run"},
          {"sequences", summary.cells},
          {"failed", summary.failed},
          {"pooled", benchmark_json(summary.kitti)["pooled"]},
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

bool same_cell(const BenchCell& a, const BenchCell& b) {
  return a.sequence == b.sequence && a.configuration == b.configuration && a.peer == b.peer;
}

bool same_findings(const BenchCell& a, const BenchCell& b) {
  const auto& all = bench_figures();
  return std::all_of(all.begin(), all.end(),
                     [&](const BenchFigure& f) { return f.measured || value_of(a, f) == value_of(b, f); });
}

BenchCell combination_of(const std::vector<const BenchCell*>& repeats) {
  BenchCell result = *repeats.front();
  for (const BenchCell* cell : repeats) {
    if (cell->failed()) result = *cell;
  }
  if (result.failed() || repeats.size() == 1) return result;
  // What is cut to keep a budget of time differs, and with it all that is found.
  const bool by_time = result.metrics.budget.has_value();
  for (const BenchCell* cell : repeats) {
    if (by_time || same_findings(*cell, result)) continue;
    result.error = fmt::format("repeat {} found something else than repeat {}", cell->repeat, result.repeat);
    result.error_code = kUnexpected;
    return result;
  }
  for (const BenchFigure& figure : bench_figures()) {
    std::vector<double> values;
    for (const BenchCell* cell : repeats) {
      const auto value = value_of(*cell, figure);
      if (value && (figure.measured || by_time)) values.push_back(*value);
    }
    std::sort(values.begin(), values.end());
    if (!values.empty()) figure.place(result.metrics) = percentile(values, 0.5);
  }
  for (const BenchCell* cell : repeats) {
    if (!by_time || cell == repeats.front() || !cell->kitti || !result.kitti) continue;
    const auto& more = cell->kitti->segments;
    result.kitti->segments.insert(result.kitti->segments.end(), more.begin(), more.end());
  }
  result.metrics.repeats = repeats.size();
  return result;
}

}  // namespace

const std::vector<BenchFigure>& bench_figures() {
  using M = RunMetrics;
  using E = EvaluationMetrics;
  static const std::vector<BenchFigure> kFigures = {
      figure<&M::evaluation, &E::t_rel_pct>("t_rel_pct", "t_rel %", 4),
      figure<&M::evaluation, &E::r_rel_deg_per_100m>("r_rel_deg_per_100m", "r_rel °/100m", 4),
      figure<&M::evaluation, &E::ape_m, &ErrorMetrics::rmse>("ape_rmse_m", "APE rmse m", 4),
      figure<&M::evaluation, &E::ape_m, &ErrorMetrics::mean>("ape_mean_m", "APE mean m", 4),
      figure<&M::evaluation, &E::ape_m, &ErrorMetrics::std>("ape_std_m", "APE std m", 4),
      figure<&M::evaluation, &E::ape_unaligned_m, &ErrorMetrics::rmse>("ape_unaligned_rmse_m", "unaligned rmse m", 4),
      figure<&M::evaluation, &E::rpe_frame_m, &ErrorMetrics::rmse>("rpe_frame_rmse_m", "RPE m", 4),
      figure<&M::evaluation, &E::rpe_frame_deg, &ErrorMetrics::rmse>("rpe_frame_rmse_deg", "RPE °", 4),
      figure<&M::ms, &TimingMetrics::mean>("ms_mean", "ms mean", 1, true),
      figure<&M::ms, &TimingMetrics::median>("ms_median", "median", 1, true),
      figure<&M::ms, &TimingMetrics::p95>("ms_p95", "p95", 1, true),
      figure<&M::ms, &TimingMetrics::p99>("ms_p99", "p99", 1, true),
      figure<&M::ms, &TimingMetrics::max>("ms_max", "max", 1, true),
      figure<&M::mean_iterations>("mean_iterations", "iterations", 2),
      figure<&M::selection_rate_pct>("selection_rate_pct", "selected %", 2),
      figure<&M::coarse_rate_pct>("coarse_rate_pct", "coarse %", 2),
      figure<&M::peak_rss_mb>("peak_rss_mb", "peak MiB", 0, true),
      figure<&M::elevation_offset_applied_deg>("elevation_offset_applied_deg", "own °", 3)};
  return kFigures;
}

const BenchFigure& bench_figure(const std::string& key) {
  const auto& all = bench_figures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const BenchFigure& figure) { return key == figure.key; });
  if (found == all.end()) throw std::logic_error("no figure " + key);
  return *found;
}

std::optional<double> value_of(const BenchCell& cell, const BenchFigure& figure) {
  return cell.failed() ? std::nullopt : figure.get(cell.metrics);
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

std::vector<BenchCell> combined(const std::vector<BenchCell>& cells) {
  std::vector<std::vector<const BenchCell*>> groups;
  for (const BenchCell& cell : cells) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return same_cell(*g.front(), cell); });
    if (group == groups.end()) group = groups.insert(groups.end(), std::vector<const BenchCell*>());
    group->push_back(&cell);
  }
  std::vector<BenchCell> result;
  result.reserve(groups.size());
  for (const auto& group : groups) result.push_back(combination_of(group));
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

}  // namespace rilo
