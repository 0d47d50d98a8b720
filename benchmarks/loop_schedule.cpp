#include "loop_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <queue>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "session/steady_clock.hpp"

namespace rilo::bench {
namespace {

constexpr std::size_t kRepeats = 1000;
constexpr std::size_t kDecile = kRepeats / 10;  // above it other work on the machine shows
constexpr std::int64_t kBusyNs = 100'000;        // as much as a task of the odometry
constexpr std::size_t kEmptyTasks = 1024;

void be_busy() {
  const std::int64_t end_ns = steady_ns() + kBusyNs;
  while (steady_ns() < end_ns) {
  }
}

template <typename Body>
double decile_ns(const Body& body) {
  std::vector<double> times;
  for (std::size_t i = 0; i < kRepeats; ++i) {
    be_busy();
    const std::int64_t begin_ns = steady_ns();
    body();
    times.push_back(static_cast<double>(steady_ns() - begin_ns));
  }
  std::nth_element(times.begin(), times.begin() + kDecile, times.end());
  return times[kDecile];
}

}  // namespace

double makespan_ns(const std::vector<std::int64_t>& task_ns, int threads, const ThreadCost& cost) {
  if (task_ns.empty()) {
    return 0.0;
  }
  if (threads == 1) {
    return static_cast<double>(std::accumulate(task_ns.begin(), task_ns.end(), std::int64_t{0}));
  }
  if (threads == kUnlimitedThreads) {
    return static_cast<double>(*std::max_element(task_ns.begin(), task_ns.end()));
  }
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at(
      std::greater<>(), std::vector<double>(static_cast<std::size_t>(threads), 0.0));
  double end = 0;
  for (const std::int64_t ns : task_ns) {
    const double done = free_at.top() + static_cast<double>(ns) + cost.task_ns;
    free_at.pop();
    free_at.push(done);
    end = std::max(end, done);
  }
  return end + cost.fork_join_ns * std::log2(threads);
}

ThreadCost measured_thread_cost() {
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  tbb::task_arena arena(2);
  ThreadCost cost;
  arena.execute([&] {
    const double both = decile_ns([] { tbb::parallel_for(0, 2, [](int) { be_busy(); }); });
    cost.fork_join_ns = std::max(0.0, both - static_cast<double>(kBusyNs));
  });
  tbb::task_arena alone(1);
  alone.execute([&] {
    cost.task_ns = decile_ns([] { tbb::parallel_for(std::size_t{0}, kEmptyTasks, [](std::size_t) {}); }) /
                   static_cast<double>(kEmptyTasks);
  });
  return cost;
}

}  // namespace rilo::bench
