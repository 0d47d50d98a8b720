#include "comparison_figures.hpp"

#include <algorithm>
#include <cmath>

#include "figures.hpp"

namespace rilo {

KittiError kitti_of(const RunReport& run) {
  return run.evaluation && shows_t_rel(*run.evaluation) ? run.evaluation->kitti : KittiError{};
}

namespace {

template <typename Get>
std::optional<double> of_evaluation(const RunReport& run, const Get& get) {
  return run.evaluation ? std::optional<double>(get(*run.evaluation)) : std::nullopt;
}

template <double TimingFigures::*kMember>
std::optional<double> of_timing(const RunReport& run) {
  const TimingFigures timing = timing_of(run.sweeps);
  return timing.max_ms > 0.0 ? std::optional(timing.*kMember) : std::nullopt;
}

}  // namespace

const std::vector<ComparisonFigure>& comparison_figures() {
  static const std::vector<ComparisonFigure> kFigures = {
      {{"ape_rmse_m", "APE rmse", "m", 4},
       [](const RunReport& r) {
         return of_evaluation(r, [](const Evaluation& e) { return e.ape.translation_m.rmse; });
       }},
      {{"t_rel_pct", "t_rel", "%", 4}, [](const RunReport& r) { return kitti_of(r).t_rel_pct(); }},
      {{"r_rel_deg_per_100m", "r_rel", "°/100 m", 4}, [](const RunReport& r) { return kitti_of(r).r_rel_deg_100m(); }},
      {{"ape_unaligned_rmse_m", "APE unaligned", "m", 4},
       [](const RunReport& r) {
         return of_evaluation(r, [](const Evaluation& e) { return e.ape_unaligned.translation_m.rmse; });
       }},
      {{"rpe_frame_rmse_m", "RPE per sweep", "m", 4},
       [](const RunReport& r) {
         return of_evaluation(r, [](const Evaluation& e) { return e.rpe_frame.translation_m.rmse; });
       }},
      {{"end_error_m", "End error", "m", 2},
       [](const RunReport& r) { return of_evaluation(r, [](const Evaluation& e) { return e.end_error_m; }); }},
      {{"ms_median", "Sweep time, median", "ms", 1}, of_timing<&TimingFigures::median_ms>},
      {{"ms_p99", "p99", "ms", 1}, of_timing<&TimingFigures::p99_ms>},
      {{"peak_rss_mb", "Peak memory", "MiB", 0},
       [](const RunReport& r) { return r.peak_rss_mb > 0.0 ? std::optional(r.peak_rss_mb) : std::nullopt; }}};
  return kFigures;
}

std::optional<double> value_of(const RunReport& run, const ComparisonFigure& figure) {
  std::optional<double> value = figure.of(run);
  const auto recorded = run.recorded.find(figure.what.key);
  if (!value && recorded != run.recorded.end()) value = recorded->second;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string name_of(const RunReport& run) {
  const std::string& name = run.name.empty() ? run.title : run.name;
  return name.empty() ? "LiDAR odometry run" : name;
}

std::vector<std::pair<std::string, std::vector<std::size_t>>> by_sequence(const std::vector<RunReport>& runs) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> groups;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    auto known =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.first == runs[i].sequence; });
    if (known == groups.end()) known = groups.insert(groups.end(), {runs[i].sequence, {}});
    known->second.push_back(i);
  }
  return groups;
}

ExperimentReport experiment_of(const std::vector<RunReport>& runs) {
  ExperimentReport experiment;
  experiment.title = "All sequences";
  for (const ComparisonFigure& figure : comparison_figures()) experiment.figures.push_back(figure.what);
  for (const RunReport& run : runs) {
    ExperimentCell cell{run.sequence, name_of(run), false, {}, ""};
    for (const ComparisonFigure& figure : comparison_figures()) {
      if (const auto value = value_of(run, figure)) cell.figures[figure.what.key] = *value;
    }
    experiment.cells.push_back(cell);
  }
  return experiment;
}

}  // namespace rilo
