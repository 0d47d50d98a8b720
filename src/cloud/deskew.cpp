#include "cloud/deskew.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "cloud/fixed_chunks.hpp"

namespace rilo {

namespace {
constexpr int kKnots = 129;  // see SweepMotion for the error that is left

/// Least and largest of the times; not empty. In lanes, which become vector instructions.
TimeSpan extremes_of(const std::vector<float>& times_s) {
  constexpr std::size_t kLanes = 16;
  std::array<float, kLanes> least{};
  std::array<float, kLanes> most{};
  least.fill(times_s.front());
  most.fill(times_s.front());
  std::size_t i = 0;
  for (; i + kLanes <= times_s.size(); i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      least[k] = times_s[i + k] < least[k] ? times_s[i + k] : least[k];
      most[k] = times_s[i + k] > most[k] ? times_s[i + k] : most[k];
    }
  }
  const auto rest = times_s.begin() + static_cast<std::ptrdiff_t>(i);
  return {std::min(*std::min_element(least.begin(), least.end()),
                   std::accumulate(rest, times_s.end(), least[0], [](float a, float b) { return std::min(a, b); })),
          std::max(*std::max_element(most.begin(), most.end()),
                   std::accumulate(rest, times_s.end(), most[0], [](float a, float b) { return std::max(a, b); }))};
}
}  // namespace

TimeSpan span_of(const TimedCloud& cloud) {
  return cloud.timed() ? extremes_of(cloud.offsets_s) : TimeSpan{0.0F, 0.0F};
}

SweepMotion::SweepMotion(const BodyMotion& motion, const TimeSpan& of, const Eigen::Matrix3d& R_out_sensor)
    : begin_s_(of.begin_s) {
  const float begin_s = of.begin_s;
  const float span = of.length_s();
  last_ = span > 0.0F ? kKnots - 1 : 0;
  inverse_step_ = span > 0.0F ? static_cast<float>(last_) / span : 0.0F;
  knots_.reserve(static_cast<std::size_t>(last_) + 1);
  for (int i = 0; i <= last_; ++i) {
    const float offset = last_ == 0 ? begin_s : begin_s + span * static_cast<float>(i) / static_cast<float>(last_);
    const auto s = static_cast<double>(offset);
    const Vector6d twist = motion.twist + s * motion.acceleration;
    Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
    generator.topLeftCorner<3, 3>() = hat(twist.head<3>());
    generator.topRightCorner<3, 1>() = twist.tail<3>();
    const SE3 T = SE3(R_out_sensor) * se3_exp(s * motion.twist + 0.5 * s * s * motion.acceleration);
    knots_.push_back({T.matrix().cast<float>(), (T.matrix() * generator).cast<float>(), offset});
  }
}

void deskew(const TimedCloud& cloud, const BodyMotion& motion, std::vector<Eigen::Vector3f>& out) {
  out.resize(cloud.size());
  if (!cloud.timed() || cloud.points.empty()) {
    out = cloud.points;
    return;
  }
  const SweepMotion poses = SweepMotion::during(cloud, motion);
  for_fixed_chunks(cloud.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      out[i] = poses.compensate(cloud.points[i], cloud.offsets_s[i]);
    }
  });
}

std::vector<Eigen::Vector3f> deskew_picked(const TimedCloud& cloud, const BodyMotion& motion, std::size_t count) {
  const std::size_t n = std::min(count, cloud.size());
  std::vector<Eigen::Vector3f> picked;
  picked.reserve(n);
  const SweepMotion poses = SweepMotion::during(cloud, motion);
  for (std::size_t i = 0; i < n; ++i) {
    picked.push_back(poses.compensated(cloud, i * cloud.size() / n));
  }
  return picked;
}

}  // namespace rilo
