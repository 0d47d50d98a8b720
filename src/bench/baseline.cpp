#include "bench/baseline.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "console/text.hpp"

namespace rilo {

namespace {

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

}  // namespace rilo
