#include "bench/saved_results.hpp"

#include <fmt/format.h>

#include "bench/output.hpp"
#include "bench/sensitivity.hpp"
#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "results/metrics_json.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kResults = "results.json";
constexpr const char* kExpected = "results.json or results.sqlite of rilo bench";

bool is_store(const fs::path& file) { return file.extension() == fs::path(kStoreName).extension(); }

bool is_cell(const Json& cell) {
  const auto has = [&](const char* key, auto is) { return cell.contains(key) && (cell[key].*is)(); };
  return cell.is_object() && has("sequence", &Json::is_string) && has("configuration", &Json::is_string) &&
         has("figures", &Json::is_object);
}

Json read_json_results(const fs::path& file) {
  Json json = read_json_object(file, kExpected, "Check the path");
  if (json.value("rilo_bench", Json()) != 1 || !json.contains("cells") || !json["cells"].is_array()) {
    throw IoError(
        {file, "", "JSON of another kind", std::string(kExpected) + " (\"rilo_bench\": 1 and a list cells)", ""});
  }
  for (std::size_t i = 0; i < json["cells"].size(); ++i) {
    if (is_cell(json["cells"][i])) continue;
    throw IoError(
        {file, fmt::format("cell {}", i + 1), "a cell without sequence, configuration or figures", kExpected, ""});
  }
  return json;
}

std::string text_at(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

std::size_t count_at(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_number_unsigned() ? json[key].get<std::size_t>() : 0;
}

ExperimentCell cell_of(const Json& json) {
  ExperimentCell cell;
  cell.sequence = json["sequence"];
  cell.configuration = json["configuration"];
  cell.peer = text_at(json, "kind") == "peer";
  cell.error = text_at(json, "error");
  for (const auto& [key, value] : json["figures"].items()) {
    if (value.is_number()) cell.figures[key] = value;
  }
  return cell;
}

/// What a report lets one choose from; APE first, as in the paper's figures.
std::vector<ExperimentFigure> report_figures() {
  return {{"ape_rmse_m", "APE rmse", "m", 4},
          {"t_rel_pct", "t_rel", "%", 4},
          {"r_rel_deg_per_100m", "r_rel", "°/100 m", 4},
          {"ape_unaligned_rmse_m", "APE unaligned, rmse", "m", 4},
          {"rpe_frame_rmse_m", "RPE per sweep, rmse", "m", 4},
          {"ms_mean", "Sweep time, mean", "ms", 1},
          {"ms_median", "Sweep time, median", "ms", 1},
          {"ms_p99", "Sweep time, p99", "ms", 1},
          {"mean_iterations", "Iterations", "", 2},
          {"peak_rss_mb", "Peak memory", "MiB", 0}};
}

std::string bench_notice(const Json& json, std::size_t failed) {
  const std::size_t planned = count_at(json, "cells_planned");
  const std::size_t run = count_at(json, "cells_run");
  std::string text;
  if (run < planned) {
    text =
        fmt::format("The benchmark was interrupted or is still running: {} of {} cells are finished. ", run, planned);
  }
  if (failed > 0) text += fmt::format("{} failed; see the list below.", counted(failed, "cell"));
  return text;
}

}  // namespace

bool is_saved_results(const fs::path& path) {
  if (detail::is_folder(path)) return detail::is_file(path / kResults) || detail::is_file(path / kStoreName);
  return detail::is_file(path) && (path.extension() == ".json" || is_store(path));
}

Json read_saved_results(const fs::path& path) {
  fs::path file = path;
  if (detail::is_folder(path)) file = path / (detail::is_file(path / kResults) ? kResults : kStoreName);
  return is_store(file) ? results_json(bench_output(read_store(file)).bench) : read_json_results(file);
}

ExperimentReport read_saved_bench(const fs::path& path) {
  const Json json = read_saved_results(path);
  if (json["cells"].empty()) {
    throw IoError({path, "", "a benchmark without a finished cell", "results of at least one", "Run rilo bench again"});
  }
  const fs::path folder = detail::is_folder(path) ? path : path.parent_path();
  ExperimentReport report;
  report.title = valid_utf8(last_name(folder.empty() ? "." : folder));
  report.figures = report_figures();
  std::vector<ConfigurationSettings> settings;
  std::size_t failed = 0;
  for (const Json& entry : json["cells"]) {
    report.cells.push_back(cell_of(entry));
    failed += report.cells.back().error.empty() ? 0 : 1;
    if (!report.cells.back().peer) add_settings(report.cells.back().configuration, entry, settings);
  }
  report.sensitivities = find_sensitivities(settings);
  report.notice = bench_notice(json, failed);
  report.facts = {{"Command", text_at(json, "command")},
                  {"Rilo", text_at(json, "rilo_version")},
                  {"Results", valid_utf8(path.string())}};
  for (const auto& [name, words] : settings) {
    report.facts.emplace_back(name, words.empty() ? "defaults" : fmt::format("{}", fmt::join(words, ", ")));
  }
  return report;
}

}  // namespace rilo
