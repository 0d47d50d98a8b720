// The figures a reader looks for first.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/run_report.hpp"

namespace rilo {

/// Of a path whose drift means anything.
inline constexpr double kLeastPathM = 10;
/// Whether t_rel says something: per cent of a path of centimetres do not.
bool shows_t_rel(const Evaluation& evaluation);

/// Time per sweep.
struct TimingFigures {
  double mean_ms = 0;
  double median_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};
/// All zero without sweeps. Percentiles interpolate linearly between the two nearest ranks.
TimingFigures timing_of(const std::vector<SweepResult>& sweeps);

/// One headline figure. Plain text, not escaped yet.
struct Figure {
  std::string label;
  std::string value;
  std::string unit;
  std::string note;  ///< what it says exactly
};
/// Accuracy first where truth is known, then speed, memory, size.
std::vector<Figure> headline_figures(const RunReport& run);

/// Status names with their number of sweeps, in order of first appearance.
std::vector<std::pair<std::string, std::size_t>> status_counts(const std::vector<SweepResult>& sweeps);

}  // namespace rilo
