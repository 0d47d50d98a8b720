// How long the parallel loops of a sweep would take on more threads than the machine has.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace rilo::bench {

/// What running in parallel costs beside the work, ns.
struct ThreadCost {
  double fork_join_ns = 0;  ///< of a loop, for each doubling of the threads: they are woken as a tree
  double task_ns = 0;       ///< of a task
};

/// That many threads, with a cost of their own: the longest task remains.
inline constexpr int kUnlimitedThreads = std::numeric_limits<int>::max();

/// Duration of a loop (ns) in which the first thread that is free takes the next task. On one thread: the sum of the
/// tasks. On unlimited ones: the longest task, at no cost.
double makespan_ns(const std::vector<std::int64_t>& task_ns, int threads, const ThreadCost& cost);

/// Measured with two threads of oneTBB: loops of two tasks, after a stretch of serial work as between the loops of a
/// sweep. Lowest deciles.
ThreadCost measured_thread_cost();

}  // namespace rilo::bench
