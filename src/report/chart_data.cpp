#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "birds_eye.hpp"
#include "figures.hpp"
#include "html_sections.hpp"
#include "html_text.hpp"

namespace rilo {

namespace {

using Json = nlohmann::json;

template <typename Row, typename Value>
Json column(const std::vector<Row>& rows, Value value) {
  Json result = Json::array();
  for (const Row& row : rows) result.push_back(rounded(static_cast<double>(value(row))));
  return result;
}

Json positions(const std::vector<SE3>& poses) {
  return {{"x", column(poses, [](const SE3& T) { return T.translation().x(); })},
          {"y", column(poses, [](const SE3& T) { return T.translation().y(); })},
          {"z", column(poses, [](const SE3& T) { return T.translation().z(); })}};
}

Json errors(const std::vector<ErrorSample>& series) {
  return {{"distance", column(series, [](const ErrorSample& s) { return s.distance_m; })},
          {"translation", column(series, [](const ErrorSample& s) { return s.translation_m; })},
          {"rotation", column(series, [](const ErrorSample& s) { return s.rotation_deg; })},
          {"along", column(series, [](const ErrorSample& s) { return s.axis_m.x(); })},
          {"cross", column(series, [](const ErrorSample& s) { return s.axis_m.y(); })},
          {"height", column(series, [](const ErrorSample& s) { return s.axis_m.z(); })}};
}

/// Names once, then one index per sweep.
template <typename Word>
Json coded(const std::vector<SweepResult>& sweeps, const Word& word) {
  std::vector<std::string> names;
  Json codes = Json::array();
  for (const SweepResult& sweep : sweeps) {
    auto found = std::find(names.begin(), names.end(), to_string(word(sweep)));
    if (found == names.end()) found = names.emplace(names.end(), to_string(word(sweep)));
    codes.push_back(found - names.begin());
  }
  return {{"names", names}, {"codes", codes}};
}

Json sweeps_of(const RunReport& run) {
  const auto stat = [&run](auto member) {
    return column(run.sweeps, [member](const SweepResult& s) { return s.stats.*member; });
  };
  const auto time = [&run](double StageTimes::*stage) {
    return column(run.sweeps, [stage](const SweepResult& s) { return s.stats.times.*stage; });
  };
  const TimingFigures t = timing_of(run.sweeps);
  return {{"total", time(&StageTimes::total_ms)},
          {"stages", Json::array({Json::array({"preprocessing", time(&StageTimes::preprocess_ms)}),
                                  Json::array({"initial pose", time(&StageTimes::initial_pose_ms)}),
                                  Json::array({"registration", time(&StageTimes::registration_ms)}),
                                  Json::array({"map update", time(&StageTimes::map_ms)})})},
          {"iterations", stat(&SweepStats::iterations)},
          {"inliers", column(run.sweeps,
                             [](const SweepResult& s) {
                               return s.stats.iterations > 0 ? s.stats.inlier_ratio
                                                             : std::numeric_limits<double>::quiet_NaN();
                             })},
          {"sigma", stat(&SweepStats::sigma_th_m)},
          {"status", coded(run.sweeps, [](const SweepResult& s) { return s.status; })},
          {"initial", coded(run.sweeps, [](const SweepResult& s) { return s.stats.initial_pose; })},
          {"median", rounded(t.median_ms)},
          {"p95", rounded(t.p95_ms)},
          {"p99", rounded(t.p99_ms)},
          {"max", rounded(t.max_ms)},
          {"period", rounded(run.sweep_period_ms)}};
}

Json map_of(const RunReport& run) {
  const std::optional<BirdsEyeMap> map = draw_birds_eye(run.map_points, run.estimate);
  if (!map) return nullptr;
  Json colours = Json::array();
  for (const Rgba& c : map_colours()) colours.push_back({c[0], c[1], c[2]});
  return {{"url", png_data_url(map->image)},
          {"width", map->image.width},
          {"height", map->image.height},
          {"left", map->min_x_m},
          {"top", map->max_y_m},
          {"scale", map->metres_per_pixel},
          {"colours", colours},
          {"low", kMapColourLowM},
          {"high", kMapColourHighM}};
}

}  // namespace

std::string chart_data(const RunReport& run) {
  Json data{{"estimate", positions(run.estimate)}, {"truth", positions(run.truth)}};
  data["numbers"] = run.numbers.empty() ? Json(nullptr) : Json(run.numbers);
  data["errors"] = run.evaluation ? errors(run.evaluation->series) : Json(nullptr);
  data["sweeps"] = run.sweeps.empty() ? Json(nullptr) : sweeps_of(run);
  data["map"] = map_of(run);
  return embedded_json(data);
}

}  // namespace rilo
