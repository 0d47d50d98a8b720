// One sequence of a report: its runs and the poses of other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/report_runs.hpp"
#include "results/saved_run.hpp"

namespace rilo {

/// A run that was saved, or (`run` empty) a pose file.
struct ReportEntry {
  ReportInput input;
  std::optional<SavedRun> run;
};

struct ReportSequence {
  std::string name;
  std::vector<ReportEntry> entries;
  std::filesystem::path truth;  ///< given by the user: file or data folder; empty: what lies beside the data
};

/// Evaluates the entries and makes their reports; adds to `notices` what does not compare.
/// @throws IoError, RunError for given poses and truth that cannot be used.
std::vector<RunReport> reports_of(ReportSequence sequence, const PoseFlags& flags, std::vector<std::string>& notices);

}  // namespace rilo
