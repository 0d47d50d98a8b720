// The figures that runs are compared by.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/experiment_report.hpp"
#include "report/run_report.hpp"

namespace rilo {

/// Segments of a run of which a t_rel is shown, else none.
KittiError kitti_of(const RunReport& run);

/// A number of a run; the smaller the better.
struct ComparisonFigure {
  ExperimentFigure what;  ///< keys as in results.json of a benchmark
  std::optional<double> (*of)(const RunReport& run) = nullptr;
};

/// Accuracy first, then effort.
const std::vector<ComparisonFigure>& comparison_figures();

/// Computed from the run, else as recorded; nothing when it is neither, or not finite.
std::optional<double> value_of(const RunReport& run, const ComparisonFigure& figure);

/// Name for legends and tables, not escaped.
std::string name_of(const RunReport& run);

/// Sequences in the order of their first run, with the places of their runs.
std::vector<std::pair<std::string, std::vector<std::size_t>>> by_sequence(const std::vector<RunReport>& runs);

/// The runs as cells of an experiment: what they are called by sequence and name.
ExperimentReport experiment_of(const std::vector<RunReport>& runs);

}  // namespace rilo
