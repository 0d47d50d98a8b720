#include "rilo/evaluation/kitti_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

#include "geometry/degrees.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

namespace {

constexpr std::size_t kStartStep = 10;   // poses between segment starts
constexpr double kShortPathM = 150.0;    // below, hardly any 100 m segment fits
constexpr double kShortPathShare = 0.8;  // longest segment of a short path
constexpr int kLengths = 8;
constexpr double kRadPerMToDegPer100M = 100.0 * kDegPerRad;

std::vector<double> nominal_lengths(double path_m, bool short_path) {
  std::vector<double> lengths;
  for (int k = 1; k <= kLengths; ++k) {
    lengths.push_back(short_path ? kShortPathShare * path_m * k / kLengths : 100.0 * k);
  }
  return lengths;
}

/// Motion from `a` to `b`. The general inverse, not the transpose: rotations read from text are orthonormal to their
/// last printed digit only, and the devkit inverts them as they are.
SE3 motion(const SE3& a, const SE3& b) { return SE3(a.inverse(Eigen::Affine) * b); }

KittiSegment segment_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate, std::size_t first,
                           std::size_t last, double length_m) {
  const SE3 E = motion(motion(estimate[first], estimate[last]), motion(truth[first], truth[last]));
  const double cosine = std::clamp(0.5 * (E.linear().trace() - 1.0), -1.0, 1.0);
  return {first, last, length_m, E.translation().norm() / length_m, std::acos(cosine) / length_m};
}

/// Sums of the errors of segments.
struct Accumulator {
  std::size_t count = 0;
  double t_sum = 0;
  double r_sum = 0;

  void add(const KittiSegment& segment) {
    ++count;
    t_sum += segment.t_err;
    r_sum += segment.r_err_rad_per_m;
  }
  double t_rel_pct() const { return 100.0 * t_sum / static_cast<double>(count); }
  double r_rel_deg_100m() const { return kRadPerMToDegPer100M * r_sum / static_cast<double>(count); }
};

Accumulator sum_of(const std::vector<KittiSegment>& segments) {
  Accumulator sum;
  for (const KittiSegment& segment : segments) sum.add(segment);
  return sum;
}

void check_lengths(const std::vector<double>& lengths_m) {
  for (const double length : lengths_m) {
    if (!(length > 0.0) || !std::isfinite(length)) {
      throw std::invalid_argument("segment lengths must be positive metres, found " + std::to_string(length));
    }
  }
}

}  // namespace

std::optional<double> KittiError::t_rel_pct() const {
  return segments.empty() ? std::nullopt : std::optional(sum_of(segments).t_rel_pct());
}

std::optional<double> KittiError::r_rel_deg_100m() const {
  return segments.empty() ? std::nullopt : std::optional(sum_of(segments).r_rel_deg_100m());
}

std::vector<KittiLengthError> KittiError::per_length() const {
  std::map<double, Accumulator> sums;
  for (const KittiSegment& segment : segments) sums[segment.length_m].add(segment);
  std::vector<KittiLengthError> result;
  for (const auto& [length, sum] : sums) result.push_back({length, sum.count, sum.t_rel_pct(), sum.r_rel_deg_100m()});
  return result;
}

KittiError kitti_error(const std::vector<SE3>& truth, const std::vector<SE3>& estimate,
                       const std::vector<double>& lengths_m) {
  check_trajectories(truth, estimate);
  check_lengths(lengths_m);
  const std::vector<double> distances = path_lengths(truth);
  KittiError result;
  if (distances.back() <= 0.0) {
    return result;  // a sensor at rest has no error per metre
  }
  result.short_path = lengths_m.empty() && distances.back() < kShortPathM;
  const std::vector<double> lengths =
      lengths_m.empty() ? nominal_lengths(distances.back(), result.short_path) : lengths_m;
  for (std::size_t first = 0; first < truth.size(); first += kStartStep) {
    for (const double length : lengths) {
      const auto last = std::lower_bound(distances.begin(), distances.end(), distances[first] + length);
      if (last != distances.end()) {
        result.segments.push_back(
            segment_error(truth, estimate, first, static_cast<std::size_t>(last - distances.begin()), length));
      }
    }
  }
  return result;
}

KittiBenchmark kitti_benchmark(const std::vector<KittiError>& sequences) {
  KittiError pooled;
  double t_sum = 0;
  double r_sum = 0;
  double count = 0;
  for (const KittiError& sequence : sequences) {
    if (sequence.segments.empty()) continue;
    pooled.segments.insert(pooled.segments.end(), sequence.segments.begin(), sequence.segments.end());
    const Accumulator sum = sum_of(sequence.segments);
    t_sum += sum.t_rel_pct();
    r_sum += sum.r_rel_deg_100m();
    count += 1.0;
  }
  KittiBenchmark benchmark;
  if (!pooled.segments.empty()) {
    benchmark.pooled_t_rel_pct = pooled.t_rel_pct();
    benchmark.pooled_r_rel_deg_100m = pooled.r_rel_deg_100m();
    benchmark.sequence_mean_t_rel_pct = t_sum / count;
    benchmark.sequence_mean_r_rel_deg_100m = r_sum / count;
    benchmark.per_length = pooled.per_length();
  }
  return benchmark;
}

}  // namespace rilo
