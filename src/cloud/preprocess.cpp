#include "cloud/preprocess.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloud/elevation.hpp"
#include "cloud/fixed_chunks.hpp"

namespace rilo {

namespace {

constexpr int kFirstRounds = 3;            // to find the voxel of the first sweep
constexpr std::size_t kBeamSample = 4000;  // points: enough for 128 beams at little cost
constexpr std::size_t kPhaseStep = 7;      // prime: the samples of successive sweeps differ
constexpr double kSceneSmoothing = 0.1;    // about a second at 10 Hz

}  // namespace

const PreparedSweep& Preprocessor::prepare(const SweepView& sweep) {
  crop(sweep);
  normalise_times(sweep);
  prepared_.valid_points = cropped_.size();
  sample_beams();
  // A sweep without points gives no scale: the next one is still the first.
  const bool scale_unknown = source_voxel_m_ <= 0.0;
  if (scale_unknown) {
    // The first sweep finds the scale of the place; a few rounds are enough because the count goes with about the
    // square.
    source_voxel_m_ = config_.max_voxel_m;
    for (int round = 0; round < kFirstRounds; ++round) {
      downsample(source_voxel_m_);
      adapt_voxel();
    }
  }
  downsample(source_voxel_m_ > 0.0 ? source_voxel_m_ : config_.max_voxel_m);
  adapt_voxel();
  update_scene_range();
  if (scale_unknown && cropped_.size() == 0) {
    source_voxel_m_ = 0.0;
  }
  return prepared_;
}

void Preprocessor::update_scene_range() {
  if (prepared_.source.size() == 0) {
    return;
  }
  ranges_.clear();
  for (const Eigen::Vector3f& p : prepared_.source.points) {
    ranges_.push_back(p.squaredNorm());
  }
  const auto middle = ranges_.begin() + static_cast<std::ptrdiff_t>(ranges_.size() / 2);
  std::nth_element(ranges_.begin(), middle, ranges_.end());
  const double median = std::sqrt(static_cast<double>(*middle));
  prepared_.median_range_m = median;
  double& scene = prepared_.scene_range_m;
  scene = scene > 0.0 ? scene + kSceneSmoothing * (median - scene) : median;
}

void Preprocessor::downsample(double source_voxel_m) {
  const double map_voxel = config_.map_voxel_ratio * source_voxel_m;
  map_mean_.average(cropped_, map_voxel, prepared_.map_cloud);
  source_mean_.average(prepared_.map_cloud, source_voxel_m, prepared_.source);
}

void Preprocessor::adapt_voxel() {
  if (prepared_.source.size() == 0) {
    return;
  }
  // Points lie on surfaces: their number goes with 1 / voxel².
  const double ratio = static_cast<double>(prepared_.source.size()) / source_points_;
  source_voxel_m_ = std::clamp(source_voxel_m_ * std::sqrt(ratio), config_.min_voxel_m, config_.max_voxel_m);
}

void Preprocessor::set_source_points(double points) {
  // The voxel was chosen for the old number.
  if (source_voxel_m_ > 0.0) {
    source_voxel_m_ =
        std::clamp(source_voxel_m_ * std::sqrt(source_points_ / points), config_.min_voxel_m, config_.max_voxel_m);
  }
  source_points_ = points;
}

void Preprocessor::sample_beams() {
  TimedCloud& cloud = prepared_.beam_sample.cloud;
  cloud.points.clear();
  cloud.offsets_s.clear();
  prepared_.beam_sample.beams.clear();
  if (!beams_tracked_) {
    return;
  }
  // Every stride-th point, with another offset in each sweep. Odd: where the points lie firing by firing, an even step
  // would meet the same beams again and again.
  const std::size_t stride = (cropped_.size() / kBeamSample) | 1U;
  sample_phase_ = (sample_phase_ + kPhaseStep) % stride;
  for (std::size_t i = sample_phase_; i < cropped_.size(); i += stride) {
    cloud.points.push_back(cropped_.points[i]);
    if (cropped_.timed()) {
      cloud.offsets_s.push_back(cropped_.offsets_s[i]);
    }
    prepared_.beam_sample.beams.push_back(cropped_beams_[i]);
  }
}

void Preprocessor::reset() {
  beam_angles_ = BeamAngles{};
  sample_phase_ = 0;
  elevation_offset_rad_ = 0.0;
  span_known_ = false;
  source_points_ = static_cast<double>(config_.source_points);
  source_voxel_m_ = 0.0;
  prepared_.scene_range_m = 0.0;
}

/// Where the valid ones of each chunk go; returns how many there are in all.
template <typename Valid>
std::size_t Preprocessor::count_by_chunk(std::size_t count, const Valid& valid) {
  chunk_begins_.assign(chunk_count(count), 0);
  for_fixed_chunks(count, [&](std::size_t chunk, std::size_t first, std::size_t last) {
    std::size_t kept = 0;
    for (std::size_t i = first; i < last; ++i) {
      kept += valid(i) ? 1U : 0U;
    }
    chunk_begins_[chunk] = kept;
  });
  std::size_t total = 0;
  for (std::size_t& begin : chunk_begins_) {
    total += std::exchange(begin, total);
  }
  return total;
}

void Preprocessor::crop(const SweepView& sweep) {
  const bool timed = config_.deskew && sweep.times_s.size() == sweep.points.size();
  const auto min2 = static_cast<float>(config_.min_range_m * config_.min_range_m);
  const auto max2 = static_cast<float>(config_.max_range_m * config_.max_range_m);
  const bool rotated = elevation_offset_rad_ != 0.0;
  const ElevationRotation rotation(elevation_offset_rad_);
  if (beams_tracked_) {
    beam_index_.assign(sweep, beams_);
  }
  // A NaN or infinite coordinate makes the comparison false.
  const auto valid = [&](std::size_t i) {
    const float range2 = sweep.points[i].squaredNorm();
    return range2 >= min2 && range2 <= max2 && (!timed || std::isfinite(sweep.times_s[i]));
  };
  const std::size_t kept = count_by_chunk(sweep.points.size(), valid);
  cropped_.points.resize(kept);
  cropped_.offsets_s.resize(timed ? kept : 0);
  cropped_beams_.resize(beams_tracked_ ? kept : 0);
  const bool intense = intensities_kept_ && sweep.intensities.size() == sweep.points.size();
  cropped_.intensities.resize(intense ? kept : 0);
  for_fixed_chunks(sweep.points.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    std::size_t to = chunk_begins_[chunk];
    for (std::size_t i = first; i < last; ++i) {
      if (!valid(i)) {
        continue;
      }
      const Eigen::Vector3f p = rotated ? rotation(sweep.points[i]) : sweep.points[i];
      cropped_.points[to] = beams_tracked_ ? beam_angles_.corrected(p, beams_[i]) : p;
      if (beams_tracked_) {
        cropped_beams_[to] = beams_[i];
      }
      if (timed) {
        cropped_.offsets_s[to] = sweep.times_s[i];
      }
      if (intense) {
        cropped_.intensities[to] = sweep.intensities[i];
      }
      ++to;
    }
  });
}

void Preprocessor::normalise_times(const SweepView& sweep) {
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
