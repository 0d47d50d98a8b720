// One line of a scaling study: run times and memory.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo::bench {

/// Memory of this process in MB (10^6 bytes), as Linux tells it; NaN elsewhere.
struct ProcessMemory {
  double resident_mb = 0;
  double peak_mb = 0;  ///< VmHWM
};
ProcessMemory process_memory();

/// Collects the sweeps of one setting.
class MeasuredRow {
 public:
  void add(const SweepResult& result);
  void clear();
  std::size_t sweeps() const { return times_ms_.size(); }

  static void write_header(std::ostream& out);
  /// One line: study, value, sweeps, mean points of a sweep, map voxels at the end, median and 99th percentile (nearest
  /// rank) of the time, sweeps whose status was not ok, memory now.
  void write(std::ostream& out, const std::string& study, double value) const;

 private:
  std::vector<double> times_ms_;
  std::size_t points_ = 0;
  std::size_t map_voxels_ = 0;
  std::size_t not_ok_ = 0;
};

}  // namespace rilo::bench
