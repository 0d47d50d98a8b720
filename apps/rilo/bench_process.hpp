// A cell of a benchmark in a process of its own.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "bench_cell.hpp"

namespace rilo::cli {

/// run_cell in a child process: the peak memory is that of the cell, and a cell that crashes or runs out of memory
/// fails alone. Empty when InterruptGuard has a signal; the child is ended then. Must not be called with threads
/// running.
std::vector<BenchCell> run_cell_apart(const BenchSequence& sequence, const BenchConfiguration& configuration,
                                      const BenchRunFlags& flags, bool with_peers);

/// A cell without loss, for the way between the processes.
nlohmann::json packed(const BenchCell& cell);
BenchCell unpacked(const nlohmann::json& json);

}  // namespace rilo::cli
