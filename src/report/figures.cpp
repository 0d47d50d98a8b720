#include "figures.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "comparison_figures.hpp"
#include "evaluation/percentile.hpp"
#include "html_text.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

bool shows_t_rel(const Evaluation& e) { return e.path_m >= kLeastPathM && !e.kitti.segments.empty(); }

namespace {

/// Number and lengths of the segments behind t_rel.
std::string segments_of(const KittiError& kitti) {
  const std::vector<KittiLengthError> rows = kitti.per_length();
  const int digits = kitti.short_path ? 1 : 0;
  return fmt::format("{} segment{} of {} … {} m", kitti.segments.size(), kitti.segments.size() == 1 ? "" : "s",
                     number(rows.front().length_m, digits), number(rows.back().length_m, digits));
}

void add_accuracy(const Evaluation& e, std::vector<Figure>& figures) {
  if (shows_t_rel(e)) {
    figures.push_back(
        {"t_rel", number(e.kitti.t_rel_pct(), 3), "%", "translation drift, mean of " + segments_of(e.kitti)});
    figures.push_back(
        {"r_rel", number(e.kitti.r_rel_deg_100m(), 3), "°/100 m", "rotation drift over the same segments"});
  }
  figures.push_back(
      {"APE rmse", number(e.ape.translation_m.rmse, 3), "m",
       fmt::format("after SE(3) alignment; unaligned {} m", number(e.ape_unaligned.translation_m.rmse, 3))});
  figures.push_back({"End error", number(e.end_error_m, 2), "m",
                     e.path_m > 0.0 ? number(e.end_error_pct, 2) + " % of the path" : "the true path has no length"});
}

/// What can no longer be computed.
void add_recorded(const RunReport& run, std::vector<Figure>& figures) {
  for (const ComparisonFigure& figure : comparison_figures()) {
    const std::optional<double> value = value_of(run, figure);
    if (value && !figure.of(run)) {
      figures.push_back(
          {figure.what.title, number(value, figure.what.digits), figure.what.unit, "as the run recorded it"});
    }
  }
}

void add_speed(const RunReport& run, std::vector<Figure>& figures) {
  const TimingFigures t = timing_of(run.sweeps);
  if (t.max_ms <= 0.0) return;
  figures.push_back({"Sweep time", number(t.median_ms, 1), "ms",
                     fmt::format("median; p99 {} ms, max {} ms", number(t.p99_ms, 1), number(t.max_ms, 1))});
  figures.push_back(
      {"Real time", number(run.sweep_period_ms / t.mean_ms, 1), "×",
       fmt::format("{} ms between sweeps, {} ms mean", number(run.sweep_period_ms, 0), number(t.mean_ms, 1))});
}

}  // namespace

TimingFigures timing_of(const std::vector<SweepResult>& sweeps) {
  std::vector<double> ms;
  double sum = 0;
  for (const SweepResult& sweep : sweeps) {
    const double total_ms = sweep.stats.times.total_ms;
    if (!std::isfinite(total_ms)) continue;
    ms.push_back(total_ms);
    sum += total_ms;
  }
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  return {sum / static_cast<double>(ms.size()), percentile(ms, 0.5), percentile(ms, 0.95), percentile(ms, 0.99),
          ms.back()};
}

std::vector<Figure> headline_figures(const RunReport& run) {
  std::vector<Figure> figures;
  if (run.evaluation) add_accuracy(*run.evaluation, figures);
  add_recorded(run, figures);
  add_speed(run, figures);
  if (run.peak_rss_mb > 0.0) {
    figures.push_back({"Peak memory", number(run.peak_rss_mb, 0), "MiB", "resident set of the whole process"});
  }
  if (!run.evaluation) {
    const double path = run.estimate.empty() ? 0.0 : path_lengths(run.estimate).back();
    figures.push_back({"Distance", number(path, path < 1000.0 ? 1 : 0), "m", "length of the estimated path"});
  }
  return figures;
}

std::vector<std::pair<std::string, std::size_t>> status_counts(const std::vector<SweepResult>& sweeps) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const SweepResult& sweep : sweeps) {
    const std::string_view name = to_string(sweep.status);
    auto known = std::find_if(counts.begin(), counts.end(), [&](const auto& entry) { return entry.first == name; });
    if (known == counts.end()) known = counts.emplace(counts.end(), name, 0);
    ++known->second;
  }
  return counts;
}

}  // namespace rilo
