// Times of the tasks of parallel loops. In builds with RILO_RECORD_LOOPS alone, for benchmarks/loops.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rilo {

/// One parallel loop.
struct RecordedLoop {
  const char* name = "";              ///< signature with the type of the loop's body, which names the function it is in
  std::int64_t begin_ns = 0;          ///< of the clock
  std::vector<std::int64_t> task_ns;  ///< duration of each task, in the order of their indices
};

/// While one lives, parallel loops run on the thread that calls them, task by task, and are recorded. Loops inside a
/// task count as a part of it. Not thread-safe; one at a time.
class LoopRecord {
 public:
  using Clock = std::int64_t (*)();  ///< ns

  explicit LoopRecord(Clock clock) : clock_(clock) { living = this; }
  ~LoopRecord() { living = nullptr; }
  LoopRecord(const LoopRecord&) = delete;
  LoopRecord& operator=(const LoopRecord&) = delete;

  /// Null: loops are parallel.
  static LoopRecord* current() { return living; }

  /// Loops since the last call, in the order in which they ran.
  std::vector<RecordedLoop> take() { return std::exchange(loops_, {}); }

  template <typename Body>
  void run(const char* name, std::size_t count, const Body& body) {
    if (inside_) {
      for (std::size_t i = 0; i < count; ++i) {
        body(i);
      }
      return;
    }
    inside_ = true;
    RecordedLoop loop{name, clock_(), std::vector<std::int64_t>(count)};
    std::int64_t begin_ns = loop.begin_ns;
    for (std::size_t i = 0; i < count; ++i) {
      body(i);
      const std::int64_t end_ns = clock_();
      loop.task_ns[i] = end_ns - std::exchange(begin_ns, end_ns);
    }
    loops_.push_back(std::move(loop));
    inside_ = false;
  }

 private:
  inline static LoopRecord* living = nullptr;

  Clock clock_;
  bool inside_ = false;
  std::vector<RecordedLoop> loops_;
};

}  // namespace rilo
