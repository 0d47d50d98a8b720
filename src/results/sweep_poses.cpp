#include "results/sweep_poses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cloud/deskew.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

/// Middle of the earliest and latest finite time; 0 without times.
float middle_s(const std::vector<float>& times_s) {
  std::optional<std::pair<float, float>> span;
  for (const float t : times_s) {
    if (!std::isfinite(t)) continue;
    span = span ? std::pair(std::min(span->first, t), std::max(span->second, t)) : std::pair(t, t);
  }
  return span ? 0.5F * (span->first + span->second) : 0.0F;
}

}  // namespace

SweepPoses::SweepPoses(PoseFile file, const PairingOptions& options)
    : file_(std::move(file)),
      max_gap_s_(options.max_gap_s),
      by_stamp_(file_.stamped && options.pairing != Pairing::kIndex) {
  if (options.pairing == Pairing::kStamp && !file_.stamped) {
    throw RunError(RunErrorKind::kUsage, "--associate stamp needs stamps in POSES; a KITTI pose file has none");
  }
  const auto late = std::adjacent_find(file_.trajectory.begin(), file_.trajectory.end(),
                                       [](const auto& a, const auto& b) { return a.stamp_ns >= b.stamp_ns; });
  if (by_stamp_ && late != file_.trajectory.end()) {
    throw RunError(RunErrorKind::kBadData,
                   fmt::format("{}: the stamp of pose {} is not later than the one before; expected increasing "
                               "stamps. Sort the file, or take --associate index",
                               file_.file.string(), late - file_.trajectory.begin() + 1));
  }
}

std::optional<SweepPose> SweepPoses::of(const Sweep& sweep, std::size_t index, double period_s) const {
  std::size_t i = index;
  if (by_stamp_) {
    const std::int64_t instant_ns = sweep.stamp_ns + std::llround(static_cast<double>(middle_s(sweep.times_s)) * 1e9);
    i = nearest(instant_ns);
    if (i < size() && std::abs(static_cast<double>(file_.trajectory[i].stamp_ns - instant_ns)) > max_gap_s_ * 1e9) {
      return std::nullopt;
    }
  }
  if (i >= size()) return std::nullopt;
  return SweepPose{file_.trajectory[i].T_odom_lidar, twist(i, period_s)};
}

std::size_t SweepPoses::nearest(std::int64_t stamp_ns) const {
  const auto& poses = file_.trajectory;
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                       [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  const auto i = static_cast<std::size_t>(after - poses.begin());
  if (i == 0) return i;
  if (i == size() || stamp_ns - poses[i - 1].stamp_ns <= poses[i].stamp_ns - stamp_ns) return i - 1;
  return i;
}

// Between the neighbouring poses: what the trajectory itself says about the motion during the sweep.
Vector6d SweepPoses::twist(std::size_t i, double period_s) const {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = std::min(i + 1, size() - 1);
  if (before == after) return Vector6d::Zero();
  const StampedPose& a = file_.trajectory[before];
  const StampedPose& b = file_.trajectory[after];
  const double dt_s =
      by_stamp_ ? static_cast<double>(b.stamp_ns - a.stamp_ns) * 1e-9 : static_cast<double>(after - before) * period_s;
  return se3_log(a.T_odom_lidar.inverse() * b.T_odom_lidar) / dt_s;
}

std::string SweepPoses::protocol() const {
  return by_stamp_ ? fmt::format("paired by stamp, at most {} s apart", max_gap_s_) : "paired by index";
}

std::vector<Eigen::Vector3f> points_at(const Sweep& sweep, const SweepPose& pose) {
  if (sweep.times_s.empty()) return sweep.points;
  const float middle = middle_s(sweep.times_s);
  TimedCloud cloud{sweep.points, sweep.times_s};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isfinite(cloud.offsets_s[i])) {  // of unknown time: dropped as NaN
      cloud.points[i].setConstant(std::numeric_limits<float>::quiet_NaN());
      cloud.offsets_s[i] = middle;
    }
    cloud.offsets_s[i] -= middle;
  }
  std::vector<Eigen::Vector3f> points;
  deskew(cloud, {pose.twist}, points);
  return points;
}

}  // namespace rilo
