#include "cloud/valid_points.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_block.hpp"

namespace rilo {

namespace {
constexpr float kTimeSlack = 0.25F;  // of the usual span of the times: what is beyond is of no return of the sweep ...
constexpr double kMostStray = 0.02;  // ... unless that many points are, as in a sweep that is longer
}  // namespace

void ValidPoints::find(const SweepView& sweep, bool timed) {
  find_measured(sweep, timed);
  if (timed) {
    drop_stray_times(sweep);
    for (const Chunk& chunk : chunks_) {
      times_.widen(chunk.times);
    }
  }
  drop_flakes(sweep);
  count_chunks();
}

/// Which points are finite and within range, and the span of their times.
void ValidPoints::find_measured(const SweepView& sweep, bool timed) {
  const std::size_t count = sweep.points.size();
  flags_.resize(count);
  chunks_.assign(chunk_count(count), {});
  // (0, 0, 0) stands for no return.
  const float min2 =
      std::max(static_cast<float>(config_.min_range_m * config_.min_range_m), std::numeric_limits<float>::min());
  const auto max2 = static_cast<float>(config_.max_range_m * config_.max_range_m);
  for_fixed_chunks(count, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    PointBlock p;
    alignas(64) PointBlock::Lanes<float> times{};
    alignas(64) PointBlock::Lanes<int> valid;
    alignas(64) PointBlock::Lanes<float> begins;
    alignas(64) PointBlock::Lanes<float> ends;
    Chunk& found = chunks_[chunk];
    begins.fill(found.times.begin_s);
    ends.fill(found.times.end_s);
    for_each_block(begin, end, [&](std::size_t first, std::size_t n) {
      p.load(&sweep.points[first], n);
      if (timed) {
        std::copy_n(sweep.times_s.begin() + static_cast<std::ptrdiff_t>(first), n, times.begin());
      }
      find_in_range(p, min2, max2, times, valid);
      std::fill(valid.begin() + static_cast<std::ptrdiff_t>(n), valid.end(), 0);
      std::transform(valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(n), &flags_[first],
                     [](int in_range) { return static_cast<std::uint8_t>(in_range); });
      if (timed) {
        widen_spans(times, valid, begins, ends);
      }
    });
    found.times = {*std::min_element(begins.begin(), begins.end()), *std::max_element(ends.begin(), ends.end())};
  });
}

/// A single time that is none of the sweep, as of a packet from elsewhere, would move the middle of all sweeps after
/// it.
void ValidPoints::drop_stray_times(const SweepView& sweep) {
  TimeSpan now;
  for (const Chunk& chunk : chunks_) {
    now.widen(chunk.times);
  }
  const TimeSpan usual = times_.empty() ? bulk_of(sweep.times_s, flags_) : times_;
  const float slack = kTimeSlack * usual.length_s();
  const TimeSpan allowed{usual.begin_s - slack, usual.end_s + slack};
  if (now.empty() || !(slack > 0.0F) || allowed.contains(now)) {
    return;
  }
  const auto is_stray = [&](std::size_t i) { return flags_[i] != 0 && !allowed.contains(sweep.times_s[i]); };
  std::size_t strays = 0;
  for (std::size_t i = 0; i < flags_.size(); ++i) {
    strays += is_stray(i) ? 1 : 0;
  }
  const auto points = std::accumulate(flags_.begin(), flags_.end(), std::size_t{0});
  if (static_cast<double>(strays) > kMostStray * static_cast<double>(points)) {
    return;
  }
  for (Chunk& chunk : chunks_) {
    chunk.times = {};
  }
  for (std::size_t i = 0; i < flags_.size(); ++i) {
    flags_[i] = is_stray(i) ? 0 : flags_[i];
    if (flags_[i] != 0) {
      chunks_[i / kChunkSize].times.widen({sweep.times_s[i], sweep.times_s[i]});
    }
  }
}

/// In clear air the isolated returns are those of poles and twigs, which say where the sensor is.
void ValidPoints::drop_flakes(const SweepView& sweep) {
  flakes_ = 0;
  if (config_.most_isolated < 1.0 && isolated_.more_than(config_.most_isolated, sweep.points, flags_)) {
    for (std::size_t i = 0; i < flags_.size(); ++i) {
      const bool flake = flags_[i] != 0 && isolated_.isolated(i);
      flags_[i] = flake ? 0 : flags_[i];
      flakes_ += flake ? 1 : 0;
    }
  }
}

void ValidPoints::count_chunks() {
  count_ = 0;
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    const auto begin = flags_.begin() + static_cast<std::ptrdiff_t>(chunk * kChunkSize);
    const auto end = flags_.begin() + static_cast<std::ptrdiff_t>(std::min(flags_.size(), (chunk + 1) * kChunkSize));
    chunks_[chunk].before = std::exchange(count_, std::accumulate(begin, end, count_));
  }
}

}  // namespace rilo
