// How long the parallel loops of a sweep would take on more threads than the machine has.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace rilo::bench {

/// What running in parallel costs beside the work, ns.
struct ThreadCost {
  double wake_ns = 0;  ///< until a thread that was woken begins; each that runs wakes another one, so that they double
  double task_ns = 0;  ///< of a task
};

/// That many threads, with a cost of their own: the longest task remains.
inline constexpr int kUnlimitedThreads = std::numeric_limits<int>::max();

/// Duration of a loop (ns) in which the first thread that is free takes the next task. On one thread: the sum of the
/// tasks. On unlimited ones: the longest task, at no cost.
double makespan_ns(const std::vector<std::int64_t>& task_ns, int threads, const ThreadCost& cost);

/// Measured with two threads of oneTBB that have been idle for as long as between the loops of a sweep. The lowest
/// percent of the times: others are those of a machine that is busy.
ThreadCost measured_thread_cost();

}  // namespace rilo::bench
