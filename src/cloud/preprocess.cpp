#include "cloud/preprocess.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "cloud/fixed_chunks.hpp"
#include "cloud/measured_point.hpp"
#include "cloud/point_block.hpp"
#include "geometry/median.hpp"

namespace rilo {

namespace {

constexpr std::size_t kBeamSample = 4000;  // points: enough for 128 beams at little cost
constexpr std::size_t kPhaseStep = 8;      // shares no factor with an odd stride: all points get their turn
constexpr std::size_t kTimeSample = 100;   // points: a unit is wrong for nearly all of them
constexpr double kMostGrowth = 1.15;       // of the voxel in a sweep: its number of points changes by a third
constexpr double kSceneSmoothing = 0.1;    // about a second at 10 Hz

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

void Preprocessor::crop(const SweepView& sweep) {
  const bool timed = config_.deskew && sweep.times_s.size() == sweep.points.size();
  valid_.find(sweep, timed);
  prepared_.flakes = valid_.flakes();
  const float mid_s = timed ? valid_.middle_s() : 0.0F;
  const auto mid_ns = static_cast<std::int64_t>(std::llround(static_cast<double>(mid_s) * 1e9));
  if (__builtin_add_overflow(sweep.stamp_ns, mid_ns, &prepared_.mid_stamp_ns)) {
    prepared_.mid_stamp_ns = sweep.stamp_ns;  // a stamp that no clock has
  }
  if (beams_tracked_) {
    beam_index_.assign(sweep, beams_);
  }
  const std::size_t kept = valid_.count();
  const bool intense = intensities_kept_ && sweep.intensities.size() == sweep.points.size();
  cropped_.points.resize(kept);
  cropped_.offsets_s.resize(timed ? kept : 0);
  cropped_.intensities.resize(intense ? kept : 0);
  cropped_beams_.resize(beams_tracked_ ? kept : 0);
  for_fixed_chunks(sweep.points.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    crop_chunk(sweep, mid_s, first, last, valid_.before(chunk));
  });
}

/// The valid ones of the points first … last − 1, at their right angles, to place `to` and those behind it.
void Preprocessor::crop_chunk(const SweepView& sweep, float mid_s, std::size_t first, std::size_t last,
                              std::size_t to) {
  const bool timed = !cropped_.offsets_s.empty();
  const bool intense = !cropped_.intensities.empty();
  PointBlock p;
  alignas(64) PointBlock::Lanes<float> elevation{};
  alignas(64) PointBlock::Lanes<float> azimuth{};
  for_each_block(first, last, [&](std::size_t begin, std::size_t n) {
    const std::span valid = valid_.flags().subspan(begin, n);
    p.load(&sweep.points[begin], n);
    if (elevation_turn_) {
      rotate_elevation(p, *elevation_turn_);
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
  elevation_turn_.reset();
  valid_.reset();
  source_points_ = static_cast<double>(config_.source_points);
  source_voxel_m_ = 0.0;
  prepared_.scene_range_m = 0.0;
}

}  // namespace rilo
