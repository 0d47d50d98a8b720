#include "loop_schedule.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <numeric>
#include <queue>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "io/steady_clock.hpp"

namespace rilo::bench {
namespace {

constexpr std::size_t kRepeats = 1000;
constexpr std::size_t kRank = kRepeats / 100;
constexpr std::int64_t kPauseNs = 50'000;  // as long as the serial work between two loops
constexpr std::int64_t kTaskNs = 300'000;  // longer than a thread needs to wake up
constexpr std::size_t kEmptyTasks = 1024;

void be_busy(std::int64_t duration_ns) {
  const std::int64_t end_ns = steady_ns() + duration_ns;
  while (steady_ns() < end_ns) {
  }
}

template <typename Body>
double lowest_ns(const Body& body) {
  std::vector<double> times;
  for (std::size_t i = 0; i < kRepeats; ++i) {
    be_busy(kPauseNs);
    const std::int64_t begin_ns = steady_ns();
    body();
    times.push_back(static_cast<double>(steady_ns() - begin_ns));
  }
  std::nth_element(times.begin(), times.begin() + kRank, times.end());
  return times[kRank];
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
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  for (unsigned i = 0; i < static_cast<unsigned>(threads); ++i) {
    free_at.push(cost.wake_ns * std::bit_width(i));
  }
  double end = 0;
  for (const std::int64_t ns : task_ns) {
    const double done = free_at.top() + static_cast<double>(ns) + cost.task_ns;
    free_at.pop();
    free_at.push(done);
    end = std::max(end, done);
  }
  return end;
}

ThreadCost measured_thread_cost() {
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  tbb::task_arena arena(2);
  ThreadCost cost;
  arena.execute([&] {
    const double both = lowest_ns([] { tbb::parallel_for(0, 2, [](int) { be_busy(kTaskNs); }); });
    cost.wake_ns = std::max(0.0, both - static_cast<double>(kTaskNs));
  });
  tbb::task_arena alone(1);
  alone.execute([&] {
    cost.task_ns = lowest_ns([] { tbb::parallel_for(std::size_t{0}, kEmptyTasks, [](std::size_t) {}); }) /
                   static_cast<double>(kEmptyTasks);
  });
  return cost;
}

}  // namespace rilo::bench
