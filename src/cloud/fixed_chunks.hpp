// Parallel loops whose results cannot depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif
#if defined(RILO_RECORD_LOOPS)
#include "cloud/loop_record.hpp"
#endif

namespace rilo {

/// Tells ThreadSanitizer how oneTBB's packaged library, which it cannot look into, hands work over: what came before
/// give() is seen after take() of the same object.
struct HandOver {
#if defined(__SANITIZE_THREAD__)
  void give() { __tsan_release(this); }
  void take() { __tsan_acquire(this); }
#else
  void give() {}
  void take() {}
#endif
};

/// Calls body(i) for i = 0 … count − 1, in parallel. What body(i) writes must depend on i alone.
template <typename Body>
void for_each_index(std::size_t count, const Body& body) {
  if (count <= 1) {
    if (count == 1) {
      body(0);
    }
    return;
  }
#if defined(RILO_RECORD_LOOPS)
  if (LoopRecord* record = LoopRecord::current()) {
    record->run(__PRETTY_FUNCTION__, count, body);
    return;
  }
#endif
  HandOver work;
  HandOver results;
  work.give();
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    work.take();
    body(i);
    results.give();
  });
  results.take();
}

inline constexpr std::size_t kChunkSize = 1024;      // large against the cost of a task
inline constexpr std::size_t kSmallChunkSize = 128;  // for items that are much work

/// Number of chunks that for_fixed_chunks cuts `count` items into.
template <std::size_t Size = kChunkSize>
constexpr std::size_t chunk_count(std::size_t count) {
  return (count + Size - 1) / Size;
}

/// Calls body(chunk, first, last) for consecutive chunks of `Size` items, in parallel. The cut depends on `count` and
/// `Size` alone: sums kept per chunk and added in the order of the chunks are the same bits for any number of threads.
template <std::size_t Size = kChunkSize, typename Body>
void for_fixed_chunks(std::size_t count, const Body& body) {
  for_each_index(chunk_count<Size>(count),
                 [&](std::size_t chunk) { body(chunk, chunk * Size, std::min(count, (chunk + 1) * Size)); });
}

}  // namespace rilo
