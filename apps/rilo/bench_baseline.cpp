#include "bench_baseline.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "json_file.hpp"
#include "rilo/io/io_error.hpp"
#include "text.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kExpected = "results.json of an earlier rilo bench";

using Key = std::pair<std::string, std::string>;

bool is_cell(const nlohmann::json& cell) {
  const auto has = [&](const char* key, auto is) { return cell.contains(key) && (cell[key].*is)(); };
  return cell.is_object() && has("sequence", &nlohmann::json::is_string) &&
         has("configuration", &nlohmann::json::is_string) && has("figures", &nlohmann::json::is_object);
}

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

nlohmann::json read_baseline(const std::filesystem::path& file) {
  nlohmann::json json = read_json_object(file, kExpected, "Check the path after --baseline");
  if (json.value("rilo_bench", nlohmann::json()) != 1 || !json.contains("cells") || !json["cells"].is_array()) {
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

}  // namespace rilo::cli
