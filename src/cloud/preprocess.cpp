#include "rilo/cloud/preprocess.hpp"

#include <algorithm>
#include <cmath>

namespace rilo {

namespace {

void gather(const TimedCloud& from, const std::vector<std::uint32_t>& indices, TimedCloud& to) {
  to.points.clear();
  to.offsets_s.clear();
  for (const std::uint32_t i : indices) {
    to.points.push_back(from.points[i]);
  }
  if (from.timed()) {
    for (const std::uint32_t i : indices) {
      to.offsets_s.push_back(from.offsets_s[i]);
    }
  }
}

}  // namespace

const PreparedSweep& Preprocessor::prepare(const Sweep& sweep) {
  crop(sweep);
  normalise_times(sweep);
  prepared_.valid_points = cropped_.size();
  gather(cropped_, map_sampler_.sample(cropped_.points, config_.map_voxel_m), prepared_.map_cloud);
  const TimedCloud& dense = prepared_.map_cloud;
  gather(dense, source_sampler_.sample(dense.points, config_.source_voxel_m), prepared_.source);
  return prepared_;
}

void Preprocessor::reset() {
  span_known_ = false;
}

void Preprocessor::crop(const Sweep& sweep) {
  const bool timed = config_.deskew && sweep.times_s.size() == sweep.points.size();
  const auto min2 = static_cast<float>(config_.min_range_m * config_.min_range_m);
  const auto max2 = static_cast<float>(config_.max_range_m * config_.max_range_m);
  cropped_.points.clear();
  cropped_.offsets_s.clear();
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const float range2 = sweep.points[i].squaredNorm();
    // A NaN or infinite coordinate makes the comparison false.
    if (!(range2 >= min2 && range2 <= max2) || (timed && !std::isfinite(sweep.times_s[i]))) {
      continue;
    }
    cropped_.points.push_back(sweep.points[i]);
    if (timed) {
      cropped_.offsets_s.push_back(sweep.times_s[i]);
    }
  }
}

void Preprocessor::normalise_times(const Sweep& sweep) {
  prepared_.mid_stamp_ns = sweep.stamp_ns;
  if (!cropped_.timed()) {
    return;
  }
  const auto [begin, end] = std::minmax_element(cropped_.offsets_s.begin(), cropped_.offsets_s.end());
  span_begin_s_ = span_known_ ? std::min(span_begin_s_, *begin) : *begin;
  span_end_s_ = span_known_ ? std::max(span_end_s_, *end) : *end;
  span_known_ = true;
  const float mid = 0.5F * (span_begin_s_ + span_end_s_);
  for (float& offset : cropped_.offsets_s) {
    offset -= mid;
  }
  prepared_.mid_stamp_ns += static_cast<std::int64_t>(std::llround(static_cast<double>(mid) * 1e9));
}

}  // namespace rilo
