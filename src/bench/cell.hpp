// One cell of a benchmark: a configuration on a sequence.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/bench_plan.hpp"
#include "console/failure.hpp"
#include "results/metrics.hpp"
#include "results/run_request.hpp"
#include "rilo/evaluation/kitti_error.hpp"

namespace rilo {

struct BenchCell {
  std::string sequence;
  std::string configuration;          ///< name of the configuration or of the peer
  bool peer = false;                  ///< poses from a file
  std::vector<std::string> settings;  ///< of the configuration
  RunMetrics metrics;                 ///< of a peer only the evaluation
  std::optional<KittiError> kitti;    ///< segments, for pooling
  std::string error;                  ///< empty: it succeeded
  ExitCode error_code = kSuccess;
  std::string log = {};    ///< what the program said meanwhile, beside the results; empty: not kept
  std::size_t repeat = 1;  ///< counted from 1
  std::string group = {};  ///< of the sequence

  bool failed() const { return !error.empty(); }
};

/// How all cells are run.
struct BenchRunOptions {
  std::size_t count = 0;  ///< sweeps of every sequence; 0: as the plan says
  int threads = -1;       ///< -1: as configured
  bool quiet = false;
  SourceRequest source;  ///< where the plan does not say otherwise
};

/// The run of that sequence.
RunRequest run_request(const BenchSequence& sequence, const BenchRunOptions& flags);

/// Runs one cell, then compares the sequence's peers on the same sweeps. Errors are recorded in the cells. An
/// interrupted cell is not among them.
std::vector<BenchCell> run_cell(const BenchSequence& sequence, const BenchConfiguration& configuration,
                                const BenchRunOptions& flags);

}  // namespace rilo
