// Cells of a benchmark as Slurm job arrays.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/pool.hpp"

namespace rilo {

struct SlurmOrder {
  std::filesystem::path out;        ///< results, on a file system that the nodes share
  std::string command_line;         ///< as typed; the jobs repeat it with --cell
  std::vector<std::string> sbatch;  ///< options for sbatch
  std::size_t at_a_time = 0;        ///< 0: no limit
  std::size_t retries = 0;
};

/// Submits `open`, some of the jobs of the plan `all`, and waits for them: a cell is finished when its file is there,
/// and failed when its task left the queue without one. Tasks of an earlier call for the same `out` that are still in
/// the queue are waited for rather than submitted again. When InterruptGuard has a signal, the tasks are cancelled.
/// @throws RunError when Slurm cannot be used.
void run_on_slurm(const std::vector<BenchJob>& open, const std::vector<BenchJob>& all, const CellFolder& folder,
                  const SlurmOrder& order, const BenchEvents& events);

/// In a task: that the cell is the one that was submitted. Otherwise `folder` has the rejection as the result of that
/// one, for the one who waits. @throws RunError, kBadData
void check_submitted(const std::filesystem::path& out, std::size_t number, const BenchJob& job,
                     const CellFolder& folder);

}  // namespace rilo
