// Parallel loops whose results cannot depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

namespace rilo {

inline constexpr std::size_t kChunkSize = 1024;

/// Number of chunks that for_fixed_chunks cuts `count` items into.
inline std::size_t chunk_count(std::size_t count) { return (count + kChunkSize - 1) / kChunkSize; }

/// Calls body(chunk, first, last) for consecutive chunks of kChunkSize items, in parallel. The cut depends on `count`
/// alone: sums kept per chunk and added in the order of the chunks are the same bits for any number of threads.
template <typename Body>
void for_fixed_chunks(std::size_t count, const Body& body) {
  const std::size_t chunks = chunk_count(count);
  const auto run = [&](std::size_t chunk) {
    body(chunk, chunk * kChunkSize, std::min(count, (chunk + 1) * kChunkSize));
  };
  if (chunks <= 1) {
    if (count > 0) {
      run(0);
    }
    return;
  }
  tbb::parallel_for(std::size_t{0}, chunks, run);
}

}  // namespace rilo
