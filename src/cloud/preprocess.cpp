#include "cloud/preprocess.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "cloud/elevation.hpp"
#include "cloud/fixed_chunks.hpp"
#include "cloud/measured_point.hpp"
#include "cloud/point_block.hpp"
#include "geometry/median.hpp"

namespace rilo {

namespace {

constexpr std::size_t kBeamSample = 4000;  // points: enough for 128 beams at little cost
constexpr std::size_t kPhaseStep = 8;      // shares no factor with an odd stride: all points get their turn
constexpr std::size_t kTimeSample = 100;   // points: a unit is wrong for nearly all of them
constexpr float kTimeSlack = 0.25F;   // of the usual span of the times: what is beyond is of no return of the sweep ...
constexpr double kMostStray = 0.02;   // ... unless that many points are, as in a sweep that is longer
constexpr double kMostGrowth = 1.15;  // of the voxel in a sweep: its number of points changes by a third
constexpr double kSceneSmoothing = 0.1;  // about a second at 10 Hz

void find_angles(const BeamAngles& of, std::span<const Beam> beams, PointBlock::Lanes<float>& elevation_rad,
                 PointBlock::Lanes<float>& azimuth_rad) {
  Eigen::Vector2f angles = of.of(beams.front());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (i > 0 && beams[i] != beams[i - 1]) {
      angles = of.of(beams[i]);
    }
    elevation_rad[i] = angles.x();
    azimuth_rad[i] = angles.y();
  }
}

/// Writes at(i) of each valid point to consecutive places; returns how many.
template <typename At, typename T>
std::size_t keep(std::span<const std::uint8_t> valid, const At& at, T* to) {
  if (std::memchr(valid.data(), 0, valid.size()) == nullptr) {
    for (std::size_t i = 0; i < valid.size(); ++i) {
      to[i] = at(i);
    }
    return valid.size();
  }
  T* const first = to;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (valid[i] != 0) {
      *to++ = at(i);
    }
  }
  return static_cast<std::size_t>(to - first);
}

/// Whether the times are in another unit than seconds, or of a clock: most of a sample of them are none of a sweep. The
/// few that are would make a sweep of a few degrees.
bool is_mistimed(const SweepView& sweep) {
  if (sweep.times_s.size() != sweep.points.size()) {
    return false;
  }
  std::size_t right = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < sweep.times_s.size(); i += sweep.times_s.size() / kTimeSample + 1) {
    if (!std::isfinite(sweep.times_s[i]) || !detail::is_measured(sweep.points[i])) {
      continue;
    }
    ++(std::abs(sweep.times_s[i]) <= detail::kFarthestFromStampS ? right : wrong);
  }
  return wrong > right;
}

}  // namespace

const PreparedSweep& Preprocessor::prepare(const SweepView& sweep) {
  SweepView nothing;
  nothing.stamp_ns = sweep.stamp_ns;
  crop(config_.deskew && is_mistimed(sweep) ? nothing : sweep);
  prepared_.valid_points = cropped_.size();
  sample_beams();
  // A sweep without points gives no scale: the next one is still the first.
  const bool scale_unknown = source_voxel_m_ <= 0.0;
  if (scale_unknown) {
    // The first sweep finds the scale of the place; a few rounds are enough because the count goes with about the
    // square.
    source_voxel_m_ = config_.max_voxel_m;
    for (int pass = 1; pass < kFirstPasses; ++pass) {
      downsample(source_voxel_m_);
      adapt_voxel(std::numeric_limits<double>::infinity());
    }
  }
  downsample(source_voxel_m_ > 0.0 ? source_voxel_m_ : config_.max_voxel_m);
  // A single sparse sweep must not make the next ones dense.
  adapt_voxel(scale_unknown ? std::numeric_limits<double>::infinity() : kMostGrowth);
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
  const double median = std::sqrt(static_cast<double>(upper_median(std::span(ranges_))));
  prepared_.median_range_m = median;
  double& scene = prepared_.scene_range_m;
  scene = scene > 0.0 ? scene + kSceneSmoothing * (median - scene) : median;
}

void Preprocessor::downsample(double source_voxel_m) {
  const double map_voxel = config_.map_voxel_ratio * source_voxel_m;
  map_mean_.average(cropped_, map_voxel, prepared_.map_cloud);
  source_mean_.average(prepared_.map_cloud, source_voxel_m, prepared_.source);
}

/// By a factor of at most `most_growth`, or its inverse.
void Preprocessor::adapt_voxel(double most_growth) {
  if (prepared_.source.size() == 0) {
    return;
  }
  // Points lie on surfaces: their number goes with 1 / voxel².
  const double ratio = static_cast<double>(prepared_.source.size()) / source_points_;
  const double growth = std::clamp(std::sqrt(ratio), 1.0 / most_growth, most_growth);
  source_voxel_m_ = std::clamp(source_voxel_m_ * growth, config_.min_voxel_m, config_.max_voxel_m);
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
  times_ = {};
  source_points_ = static_cast<double>(config_.source_points);
  source_voxel_m_ = 0.0;
  prepared_.scene_range_m = 0.0;
}

/// Which points are finite and within range, and the span of their times.
void Preprocessor::find_valid(const SweepView& sweep, bool timed) {
  const std::size_t count = sweep.points.size();
  valid_.resize(count);
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
      std::transform(valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(n), &valid_[first],
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
void Preprocessor::drop_stray_times(const SweepView& sweep) {
  TimeSpan now;
  for (const Chunk& chunk : chunks_) {
    now.widen(chunk.times);
  }
  const TimeSpan usual = times_.empty() ? bulk_of(sweep.times_s, valid_) : times_;
  const float slack = kTimeSlack * usual.length_s();
  const TimeSpan allowed{usual.begin_s - slack, usual.end_s + slack};
  if (now.empty() || !(slack > 0.0F) || allowed.contains(now)) {
    return;
  }
  const auto is_stray = [&](std::size_t i) { return valid_[i] != 0 && !allowed.contains(sweep.times_s[i]); };
  std::size_t strays = 0;
  for (std::size_t i = 0; i < valid_.size(); ++i) {
    strays += is_stray(i) ? 1 : 0;
  }
  const auto points = std::accumulate(valid_.begin(), valid_.end(), std::size_t{0});
  if (static_cast<double>(strays) > kMostStray * static_cast<double>(points)) {
    return;
  }
  for (Chunk& chunk : chunks_) {
    chunk.times = {};
  }
  for (std::size_t i = 0; i < valid_.size(); ++i) {
    valid_[i] = is_stray(i) ? 0 : valid_[i];
    if (valid_[i] != 0) {
      chunks_[i / kChunkSize].times.widen({sweep.times_s[i], sweep.times_s[i]});
    }
  }
}

/// Returns how many. In clear air the isolated returns are those of poles and twigs, which say where the sensor is.
std::size_t Preprocessor::drop_flakes(const SweepView& sweep) {
  std::size_t dropped = 0;
  if (config_.most_isolated < 1.0 && isolated_.more_than(config_.most_isolated, sweep.points, valid_)) {
    for (std::size_t i = 0; i < valid_.size(); ++i) {
      const bool flake = valid_[i] != 0 && isolated_.isolated(i);
      valid_[i] = flake ? 0 : valid_[i];
      dropped += flake ? 1 : 0;
    }
  }
  return dropped;
}

/// Where the valid points of each chunk go; how many there are.
std::size_t Preprocessor::place_chunks() {
  std::size_t total = 0;
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    const auto begin = valid_.begin() + static_cast<std::ptrdiff_t>(chunk * kChunkSize);
    const auto end = valid_.begin() + static_cast<std::ptrdiff_t>(std::min(valid_.size(), (chunk + 1) * kChunkSize));
    chunks_[chunk].to = std::exchange(total, std::accumulate(begin, end, total));
  }
  return total;
}

void Preprocessor::crop(const SweepView& sweep) {
  const bool timed = config_.deskew && sweep.times_s.size() == sweep.points.size();
  find_valid(sweep, timed);
  if (timed) {
    drop_stray_times(sweep);
  }
  prepared_.flakes = drop_flakes(sweep);
  const std::size_t kept = place_chunks();
  const float mid_s = timed ? middle_of_times() : 0.0F;
  const auto mid_ns = static_cast<std::int64_t>(std::llround(static_cast<double>(mid_s) * 1e9));
  if (__builtin_add_overflow(sweep.stamp_ns, mid_ns, &prepared_.mid_stamp_ns)) {
    prepared_.mid_stamp_ns = sweep.stamp_ns;  // a stamp that no clock has
  }
  if (beams_tracked_) {
    beam_index_.assign(sweep, beams_);
  }
  cropped_.points.resize(kept);
  cropped_.offsets_s.resize(timed ? kept : 0);
  cropped_beams_.resize(beams_tracked_ ? kept : 0);
  const bool intense = intensities_kept_ && sweep.intensities.size() == sweep.points.size();
  cropped_.intensities.resize(intense ? kept : 0);
  const bool rotated = elevation_offset_rad_ != 0.0;
  const ElevationRotation rotation(elevation_offset_rad_);
  for_fixed_chunks(sweep.points.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    PointBlock p;
    alignas(64) PointBlock::Lanes<float> elevation{};
    alignas(64) PointBlock::Lanes<float> azimuth{};
    std::size_t to = chunks_[chunk].to;
    for_each_block(first, last, [&](std::size_t begin, std::size_t n) {
      const std::span valid(&valid_[begin], n);
      p.load(&sweep.points[begin], n);
      if (rotated) {
        rotate_elevation(p, rotation);
      }
      if (beams_tracked_) {
        const std::span beams(&beams_[begin], n);
        find_angles(beam_angles_, beams, elevation, azimuth);
        turn_beams(p, elevation, azimuth);
        keep(
            valid, [&](std::size_t i) { return beams[i]; }, cropped_beams_.data() + to);
      }
      if (timed) {
        keep(
            valid, [&](std::size_t i) { return sweep.times_s[begin + i] - mid_s; }, cropped_.offsets_s.data() + to);
      }
      if (intense) {
        keep(
            valid, [&](std::size_t i) { return sweep.intensities[begin + i]; }, cropped_.intensities.data() + to);
      }
      to += keep(
          valid, [&](std::size_t i) { return p.at(i); }, cropped_.points.data() + to);
    });
  });
}

/// Middle of the span of the times (s) over all sweeps so far, also for a sweep without points; 0 before the first.
float Preprocessor::middle_of_times() {
  for (const Chunk& chunk : chunks_) {
    times_.widen(chunk.times);
  }
  return times_.empty() ? 0.0F : 0.5F * (times_.begin_s + times_.end_s);
}

}  // namespace rilo
