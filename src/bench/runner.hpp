// Runs the cells of a benchmark that are not finished yet, and makes results of all.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/job.hpp"

namespace rilo {

/// How a benchmark is to be run.
struct BenchOrder {
  std::string out;  ///< folder of the results; empty: printed only, and every cell is run
  std::string baseline;
  std::string command_line;
  PaperTables tables = PaperTables::kNone;
  std::vector<BenchCell> peer_figures;  ///< of any sequences
  BenchRunOptions run;
  bool on_slurm = false;
  std::size_t at_a_time = 0;        ///< cells; 0: one here, as many as Slurm has room for there
  std::size_t retries = 0;          ///< of a cell that failed
  std::vector<std::string> sbatch;  ///< options for sbatch
};

/// @returns the exit code: of the first failure; of the signal that ended it. @throws RunError
int run_bench(const BenchOrder& order, std::vector<BenchJob> jobs);

/// What a Slurm job does: runs cell `number` (from 0) of the plan and leaves its file in `order.out`.
/// @returns the exit code of the cell. @throws RunError, kBadData when data, configuration or program are not those
/// of the submission any more.
int run_bench_cell(const BenchOrder& order, const std::vector<BenchJob>& jobs, std::size_t number);

/// What to print of a store, and how.
struct BenchView {
  std::string format;  ///< text, markdown, csv
  bool paired = false;
  bool with_times = true;
};

/// Prints what a store holds. @throws IoError
void show_bench(const std::string& store, const BenchView& view);

}  // namespace rilo
