// One cell of a benchmark: a configuration on a sequence.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "rilo/config/bench_plan.hpp"
#include "rilo/evaluation/kitti_error.hpp"
#include "run_flags.hpp"

namespace rilo::cli {

struct BenchCell {
  std::string sequence;
  std::string configuration;          ///< name of the configuration or of the peer
  bool peer = false;                  ///< poses from a file
  std::vector<std::string> settings;  ///< of the configuration
  nlohmann::json metrics;             ///< as metrics.json of `rilo run`; of a peer only the evaluation
  std::optional<KittiError> kitti;    ///< segments, for pooling
  std::string error;                  ///< empty: it succeeded
  ExitCode error_code = kSuccess;
  std::string log = {};    ///< what the program said meanwhile, beside the results; empty: not kept
  std::size_t repeat = 1;  ///< counted from 1

  bool failed() const { return !error.empty(); }
};

/// How all cells are run.
struct BenchRunFlags {
  std::size_t count = 0;  ///< sweeps of every sequence; 0: as the plan says
  int threads = -1;       ///< -1: as configured
  bool quiet = false;
  SourceFlags source;  ///< where the plan does not say otherwise
};

/// What `rilo run` would be told for that sequence.
RunFlags run_flags(const BenchSequence& sequence, const BenchRunFlags& flags);

/// Runs one cell, then compares the sequence's peers on the same sweeps. Whatever goes wrong stands in the cells. An
/// interrupted cell is not among them.
std::vector<BenchCell> run_cell(const BenchSequence& sequence, const BenchConfiguration& configuration,
                                const BenchRunFlags& flags);

}  // namespace rilo::cli
