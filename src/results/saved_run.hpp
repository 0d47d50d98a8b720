// The folder that rilo run left behind, read back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/metrics.hpp"
#include "results/run_record.hpp"

namespace rilo {

struct SavedRun {
  std::filesystem::path folder;
  RunRecord record;    ///< as far as a report needs it; without truth and evaluation; of covariances the diagonal
  RunMetrics metrics;  ///< metrics.json; what an older version did not write is empty
  std::vector<std::string> notices;  ///< what is missing and why
  bool killed = false;               ///< only partial poses: nothing is known but these
};

/// Whether the folder holds results of a run, whole or partial.
bool is_saved_run(const std::filesystem::path& folder);

/// metrics.json of a run; what an older version did not write is "unknown". @throws IoError
RunMetrics read_metrics(const std::filesystem::path& file);

/// @throws IoError when a file is missing or malformed, or the files do not belong together.
SavedRun read_saved_run(const std::filesystem::path& folder);

}  // namespace rilo
