// Recorded parallel loops, and the schedule that is computed from them.
#include "cloud/loop_record.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "cloud/fixed_chunks.hpp"
#include "loop_schedule.hpp"

namespace rilo {
namespace {

using testing::AnyOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

std::int64_t time_ns = 0;  // what the clock of these tests shows

std::int64_t shown_ns() { return time_ns; }

void sum_chunks(std::vector<std::size_t>& sizes) {
  for_fixed_chunks(2500, [&](std::size_t chunk, std::size_t first, std::size_t last) {
    sizes[chunk] = last - first;
    time_ns += static_cast<std::int64_t>(last - first);
  });
}

TEST(LoopRecord, TasksAreTimedInTheirOrder) {
  LoopRecord record(shown_ns);
  time_ns = 7;
  std::vector<std::size_t> sizes(3);
  sum_chunks(sizes);
  EXPECT_THAT(sizes, ElementsAre(1024, 1024, 452));
  const std::vector<RecordedLoop> loops = record.take();
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].begin_ns, 7);
  EXPECT_THAT(loops[0].task_ns, ElementsAre(1024, 1024, 452));
  // GCC names the function that a lambda is in, Clang its file and line.
  EXPECT_THAT(loops[0].name, AnyOf(HasSubstr("sum_chunks"), HasSubstr("lambda at ")));
  EXPECT_TRUE(record.take().empty());
}

TEST(LoopRecord, LoopsInATaskArePartOfIt) {
  LoopRecord record(shown_ns);
  for_each_index(2, [](std::size_t i) { for_each_index(i + 2, [](std::size_t) { time_ns += 10; }); });
  const std::vector<RecordedLoop> loops = record.take();
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_THAT(loops[0].task_ns, ElementsAre(20, 30));
}

TEST(LoopRecord, ASingleTaskIsSerialWork) {
  LoopRecord record(shown_ns);
  for_each_index(1, [](std::size_t) { time_ns += 10; });
  EXPECT_TRUE(record.take().empty());
}

TEST(LoopRecord, WithoutOneLoopsAreParallel) {
  { const LoopRecord record(shown_ns); }
  EXPECT_EQ(LoopRecord::current(), nullptr);
  std::vector<int> calls(100);
  for_each_index(calls.size(), [&](std::size_t i) { ++calls[i]; });
  EXPECT_THAT(calls, testing::Each(1));
}

TEST(LoopSchedule, AFreeThreadTakesTheNextTask) {
  const std::vector<std::int64_t> tasks = {30, 10, 10, 40};
  // 30 | 10 10, then 40 where 20 ends.
  EXPECT_THAT(bench::makespan_ns(tasks, 2, {}), DoubleEq(60));
  EXPECT_THAT(bench::makespan_ns(tasks, 4, {}), DoubleEq(40));
  EXPECT_THAT(bench::makespan_ns(tasks, 16, {}), DoubleEq(40));
  EXPECT_THAT(bench::makespan_ns({}, 2, {}), DoubleEq(0));
}

TEST(LoopSchedule, ThreadsBeginLateAndTasksCost) {
  const std::vector<std::int64_t> tasks = {30, 10, 10, 40};
  const bench::ThreadCost cost{15, 1};
  EXPECT_THAT(bench::makespan_ns(tasks, 1, cost), DoubleEq(90));
  // One: 0 … 31, then 37 … 78; the other: 15 … 26 … 37.
  EXPECT_THAT(bench::makespan_ns(tasks, 2, cost), DoubleEq(31 + 41));
  // The third and fourth thread wake up at 30: 0 … 31, 15 … 26 … 37, 30 … 71.
  EXPECT_THAT(bench::makespan_ns(tasks, 4, cost), DoubleEq(71));
  EXPECT_THAT(bench::makespan_ns(tasks, bench::kUnlimitedThreads, cost), DoubleEq(40));
}

}  // namespace
}  // namespace rilo
