#include "experiment_table.hpp"

#include <algorithm>
#include <cmath>

namespace rilo {

namespace {

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  const auto place = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return place;
}

}  // namespace

ExperimentTable::ExperimentTable(const ExperimentReport& experiment, const std::string& figure) {
  for (const ExperimentCell& cell : experiment.cells) {
    place_of(sequences_, cell.sequence);
    place_of(configurations_, cell.configuration);
  }
  values_.assign(sequences_.size(), std::vector<std::optional<double>>(configurations_.size()));
  for (const ExperimentCell& cell : experiment.cells) {
    const auto value = cell.figures.find(figure);
    if (cell.error.empty() && value != cell.figures.end() && std::isfinite(value->second)) {
      values_[place_of(sequences_, cell.sequence)][place_of(configurations_, cell.configuration)] = value->second;
    }
  }
  find_common();
}

void ExperimentTable::find_common() {
  std::vector<bool> has(configurations_.size(), false);
  for (const auto& row : values_) {
    for (std::size_t k = 0; k < row.size(); ++k) has[k] = has[k] || row[k];
  }
  any_ = std::find(has.begin(), has.end(), true) != has.end();
  std::vector<double> sums(configurations_.size(), 0.0);
  for (const auto& row : values_) {
    bool complete = any_;
    for (std::size_t k = 0; k < row.size(); ++k) complete = complete && (row[k] || !has[k]);
    if (!complete) continue;
    ++common_;
    for (std::size_t k = 0; k < row.size(); ++k) sums[k] += row[k].value_or(0.0);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    means_.push_back(has[k] && common_ > 0 ? std::optional(sums[k] / static_cast<double>(common_)) : std::nullopt);
  }
}

}  // namespace rilo
