// Results of runs and poses of other programs, brought together for a report.
#pragma once

#include <string>
#include <vector>

#include "bench/report_inputs.hpp"
#include "report/run_report.hpp"

namespace rilo {

/// How given pose files are to be read.
struct PoseFlags {
  bool camera_frame = false;  ///< else LiDAR frame
  double max_gap_s = 0.02;    ///< of poses with stamps
};

struct ReportRuns {
  std::vector<RunReport> runs;       ///< sequence by sequence
  std::vector<std::string> notices;  ///< what does not compare, and why
};

/// Loads, groups by sequence and evaluates. Runs of a sequence are brought into one frame where truth tells how.
/// @throws IoError for files that cannot be read, RunError when a sequence has to be named or is unknown.
ReportRuns report_runs(const std::vector<ReportInput>& inputs, const std::vector<ReportTruth>& truths,
                       const PoseFlags& flags);

}  // namespace rilo
