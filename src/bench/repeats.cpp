#include "bench/repeats.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/figures.hpp"
#include "evaluation/percentile.hpp"

namespace rilo {

namespace {

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
  for (const BenchCell* cell : repeats) {
    if (same_findings(*cell, result)) continue;
    result.error = fmt::format("repeat {} found something else than repeat {}", cell->repeat, result.repeat);
    result.error_code = kUnexpected;
    return result;
  }
  for (const BenchFigure& figure : bench_figures()) {
    std::vector<double> values;
    for (const BenchCell* cell : repeats) {
      if (const auto value = value_of(*cell, figure); figure.measured && value) values.push_back(*value);
    }
    std::sort(values.begin(), values.end());
    if (!values.empty()) figure.place(result.metrics) = percentile(values, 0.5);
  }
  result.metrics.repeats = repeats.size();
  return result;
}

}  // namespace

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

}  // namespace rilo
