// Cells of a benchmark in processes of their own, a bounded number at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bench/cell_file.hpp"

namespace rilo {

/// Told to the caller that waits.
struct BenchEvents {
  std::function<void(const BenchJob&)> started;
  std::function<void(const BenchJob&, const CellRecord&)> finished;  ///< for good: retries included
};

/// How often and how many at a time.
struct BenchEffort {
  std::size_t at_a_time = 1;
  std::size_t retries = 0;  ///< of a cell that failed
};

/// Runs each cell in a child process that leaves its file in `folder`: the peak memory is that of the cell, and one
/// that crashes or runs out of memory fails alone. Returns early when InterruptGuard has a signal; the children are
/// ended then. Must not be called with threads running. @throws RunError, kCannotWrite, when a cell cannot be
/// written.
void run_in_pool(const std::vector<BenchJob>& jobs, const CellFolder& folder, const BenchRunOptions& flags,
                 const BenchEffort& effort, const BenchEvents& events);

/// A job that left no result of its own, as its record.
CellRecord failed_record(const BenchJob& job, const CellFolder& folder, std::size_t attempts, const std::string& error,
                         ExitCode code = kUnexpected);

}  // namespace rilo
