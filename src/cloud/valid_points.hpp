// Which points of a sweep are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud/isolated_returns.hpp"
#include "cloud/time_span.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Finds the points that are finite, within range, of a time of their sweep and, when it snows, no flakes. Keeps its
/// buffers from sweep to sweep.
class ValidPoints {
 public:
  explicit ValidPoints(const PreprocessConfig& config) : config_(config) {}

  /// `timed`: the sweep has times that count.
  void find(const SweepView& sweep, bool timed);

  /// Of the points of the sweep: 0 or 1.
  std::span<const std::uint8_t> flags() const { return flags_; }

  std::size_t count() const { return count_; }

  /// How many of them lie before a chunk of for_fixed_chunks().
  std::size_t before(std::size_t chunk) const { return chunks_[chunk].before; }

  /// Isolated returns that are left out.
  std::size_t flakes() const { return flakes_; }

  /// Middle of the span of the times (s) over all timed sweeps so far; 0 when none had a point.
  float middle_s() const { return times_.empty() ? 0.0F : 0.5F * (times_.begin_s + times_.end_s); }

  /// Forgets the times of the sweeps so far.
  void reset() { times_ = {}; }

 private:
  struct Chunk {
    std::size_t before = 0;
    TimeSpan times;
  };
  void find_measured(const SweepView& sweep, bool timed);
  void drop_stray_times(const SweepView& sweep);
  void drop_flakes(const SweepView& sweep);
  void count_chunks();

  PreprocessConfig config_;
  std::vector<std::uint8_t> flags_;
  std::vector<Chunk> chunks_;
  std::size_t count_ = 0;
  std::size_t flakes_ = 0;
  IsolatedReturns isolated_;
  // The span of a single sweep jitters with the returns near its seam, and the reference time must not.
  TimeSpan times_;
};

}  // namespace rilo
