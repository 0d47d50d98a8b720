// Everything a run leaves behind, before it is written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console/failure.hpp"
#include "rilo/cloud/thinned_map.hpp"
#include "rilo/evaluation/evaluation.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

/// Ground truth of the sweeps that were run, in the LiDAR frame.
struct TruthMatch {
  std::vector<SE3> truth;     ///< of the sweeps that have one
  std::vector<SE3> estimate;  ///< the poses of the same sweeps
  std::string file;
  std::string instant;               ///< what the true poses refer to
  std::vector<std::size_t> matched;  ///< which sweeps of the run, from 0
};

/// A session's result, where it came from and what was made of it.
struct RunRecord : SessionResult {
  std::string command_line;
  std::filesystem::path data;
  std::filesystem::path calibration;  ///< file that the run began with; empty: none
  MapCloud map;                       ///< thinned points of all registered sweeps
  int signal = 0;                     ///< that ended the run early, 0: none
  std::string error;                  ///< that ended the run early, empty: none
  ExitCode error_code = kSuccess;     ///< of that error
  std::optional<TruthMatch> truth;
  std::string truth_error;  ///< why ground truth that lies there could not be used
  std::optional<Evaluation> evaluation;
};

/// Takes over what the session gave; its failure becomes run.error and run.error_code.
void take(SessionResult result, RunRecord& run);

/// Looks for ground truth beside the data and evaluates. Truth that cannot be read is reported in truth_error and does
/// not end the run.
void evaluate_run(RunRecord& run);

}  // namespace rilo
