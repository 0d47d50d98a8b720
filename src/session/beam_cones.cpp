#include "session/beam_cones.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "cloud/deskew.hpp"
#include "cloud/measured_point.hpp"
#include "cloud/thinning.hpp"
#include "cloud/timed_cloud.hpp"
#include "geometry/degrees.hpp"
#include "session/comparable_sweep.hpp"

namespace rilo {

namespace {

constexpr float kNearestM = 2.0F;    // a vehicle's own roof ends there
constexpr float kFarthestM = 20.0F;  // beyond, the way of a sweep hardly changes an elevation angle
constexpr std::size_t kLeastPoints = 1000;
constexpr std::size_t kMostPoints = 10000;      // enough: chance alone makes them as sharp as 1e-4
constexpr double kStepRad = 0.02 * kRadPerDeg;  // beams are 0.2° apart and more
constexpr double kClearly = 1.2;  // times as sharp: raw sweeps 1.5 and more, compensated ones mostly 1.3 and more
constexpr std::size_t kVotes = 10;
constexpr std::size_t kNearlyAllVotes = 9;
constexpr std::size_t kMostLookedAt = 40;

/// Measured points within the ranges above, not too many; times since the first.
TimedCloud near_points(const Sweep& sweep) {
  TimedCloud near;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f& p = sweep.points[i];
    if (!detail::is_measured(p) || !std::isfinite(sweep.times_s[i])) continue;
    if (p.squaredNorm() < kNearestM * kNearestM || p.squaredNorm() > kFarthestM * kFarthestM) continue;
    near.points.push_back(p);
    near.offsets_s.push_back(sweep.times_s[i]);
  }
  if (near.offsets_s.empty()) return near;
  near = thinned(near, std::min(1.0, static_cast<double>(kMostPoints) / static_cast<double>(near.size())));
  const float begin_s = span_of(near).begin_s;
  for (float& offset_s : near.offsets_s) offset_s -= begin_s;
  return near;
}

/// Chance that two points have the same elevation angle.
double sharpness_of(const std::vector<Eigen::Vector3f>& points) {
  std::vector<double> histogram(static_cast<std::size_t>(std::numbers::pi / kStepRad) + 2, 0.0);
  for (const Eigen::Vector3f& p : points) {
    const auto elevation_rad = static_cast<double>(std::atan2(p.z(), p.head<2>().norm()));
    ++histogram[static_cast<std::size_t>((elevation_rad + std::numbers::pi / 2) / kStepRad)];
  }
  double squares = 0;
  for (const double count : histogram) squares += count * count;
  return squares / (static_cast<double>(points.size()) * static_cast<double>(points.size()));
}

/// Of the points as they were measured, had they been compensated for `twist` to the time `reference_s`.
double sharpness_undone(TimedCloud cloud, float reference_s, const Vector6d& twist) {
  for (float& offset_s : cloud.offsets_s) offset_s -= reference_s;
  std::vector<Eigen::Vector3f> undone;
  deskew(cloud, {-twist}, undone);
  return sharpness_of(undone);
}

}  // namespace

ConeVerdict on_beam_cones(const Sweep& sweep, const Vector6d& twist) {
  const TimedCloud near = near_points(sweep);
  if (near.size() < kLeastPoints) return ConeVerdict::kNothing;
  const double as_read = sharpness_of(near.points);
  const float span_s = span_of(near).end_s;
  double undone = 0;
  for (const float reference : {0.0F, 0.5F, 1.0F}) {
    undone = std::max(undone, sharpness_undone(near, reference * span_s, twist));
  }
  if (as_read > kClearly * undone) return ConeVerdict::kRaw;
  return undone > kClearly * as_read ? ConeVerdict::kCompensated : ConeVerdict::kNothing;
}

bool ConeVotes::open() const { return raw_ + compensated_ < kVotes && looked_at_ < kMostLookedAt; }

void ConeVotes::add(const Sweep& sweep, const SweepResult& result, double turn_s) {
  if (!open() || sweep.times_s.empty() || !registered(result) || !moved(result, turn_s)) return;
  ++looked_at_;
  const ConeVerdict verdict = on_beam_cones(sweep, result.twist);
  raw_ += verdict == ConeVerdict::kRaw ? 1 : 0;
  compensated_ += verdict == ConeVerdict::kCompensated ? 1 : 0;
}

bool ConeVotes::compensated() const { return raw_ + compensated_ == kVotes && compensated_ >= kNearlyAllVotes; }

}  // namespace rilo
