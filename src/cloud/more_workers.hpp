// More threads than the machine has processors, where they are asked for.
#pragma once

#include <cstddef>
#include <optional>

#include <tbb/global_control.h>

namespace rilo {

/// Lets oneTBB have that many threads as long as it lives. Where they are allowed anyway it does nothing: of several
/// limits in a process the least counts, also for others.
class MoreWorkers {
 public:
  /// `threads`: 0 for as many as there are.
  explicit MoreWorkers(int threads) {
    constexpr auto kParallelism = tbb::global_control::max_allowed_parallelism;
    const auto wanted = static_cast<std::size_t>(threads > 0 ? threads : 0);
    if (wanted > tbb::global_control::active_value(kParallelism)) limit_.emplace(kParallelism, wanted);
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace rilo
