// What a benchmark found out: figures of cells and of configurations, results.json.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/cell.hpp"

namespace rilo {

/// A number of a cell.
struct BenchFigure {
  const char* key = "";                                    ///< in results.json and results.csv
  const char* title = "";                                  ///< in tables
  int digits = 0;                                          ///< behind the point, in tables
  bool measured = false;                                   ///< of this machine and moment: time, memory
  const MaybeNumber& (*get)(const RunMetrics&) = nullptr;  ///< its place in BenchCell::metrics
  MaybeNumber& (*place)(RunMetrics&) = nullptr;            ///< the same, to be set
};

/// All of them, accuracy first.
const std::vector<BenchFigure>& bench_figures();
const BenchFigure& bench_figure(const std::string& key);

/// Nothing where the cell failed or has no such number (no ground truth; time of a peer).
std::optional<double> value_of(const BenchCell& cell, const BenchFigure& figure);

/// All cells of one configuration that succeeded.
struct BenchSummary {
  std::string configuration;
  bool peer = false;
  std::size_t cells = 0;                     ///< that succeeded
  std::size_t failed = 0;                    ///< that did not
  KittiBenchmark kitti;                      ///< pooled over all segments of all sequences
  std::vector<std::optional<double>> means;  ///< mean over the sequences, in the order of bench_figures()
};

/// In the order in which the configurations first occur.
std::vector<BenchSummary> summaries(const std::vector<BenchCell>& cells);

/// One cell for all repeats of a configuration (or peer) on a sequence, in the order of their first ones. Times and
/// memory are the medians of the repeats; everything else is of the first, as nothing else may differ. It failed when
/// one of them did, or when they differ in what they found out.
std::vector<BenchCell> combined(const std::vector<BenchCell>& cells);

struct BenchRecord {
  std::string command_line;
  std::vector<BenchCell> cells;
  std::size_t planned = 0;  ///< cells that should have been, peers not counted
  std::size_t run = 0;      ///< of them, those that came to an end
  std::size_t count = 0;    ///< sweeps of every sequence; 0: all, or as the plan says
  int signal = 0;           ///< that ended it early, 0: none
};

/// results.json.
nlohmann::json results_json(const BenchRecord& bench);

}  // namespace rilo
