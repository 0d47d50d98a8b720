#include "results/sweep_poses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cloud/deskew.hpp"
#include "io/stamp_difference.hpp"
#include "results/sweep_times.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

float middle_s(const Sweep& sweep) { return instant_s(sweep.times_s, PoseInstant::kMid); }

}  // namespace

std::int64_t middle_ns(const Sweep& sweep) {
  return detail::stamp_difference(sweep.stamp_ns, -detail::nanoseconds(static_cast<double>(middle_s(sweep))));
}

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

std::optional<SweepPose> SweepPoses::of(const SweepWithNeighbours& sweep, double period_s) const {
  const std::size_t i = by_stamp_ ? nearest(sweep.middle_ns) : sweep.index;
  if (i >= size()) return std::nullopt;
  if (!by_stamp_) return SweepPose{file_.trajectory[i].T_odom_lidar, twist(i, sweep, period_s)};
  const std::int64_t gap_ns = detail::stamp_difference(file_.trajectory[i].stamp_ns, sweep.middle_ns);
  if (std::abs(static_cast<double>(gap_ns)) > max_gap_s_ * 1e9) {
    return std::nullopt;
  }
  return SweepPose{file_.trajectory[i].T_odom_lidar, twist(i)};
}

std::size_t SweepPoses::nearest(std::int64_t stamp_ns) const {
  const auto& poses = file_.trajectory;
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                       [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  const auto i = static_cast<std::size_t>(after - poses.begin());
  if (i == 0) return i;
  if (i == size()) return i - 1;
  const bool earlier = detail::stamp_difference(stamp_ns, poses[i - 1].stamp_ns) <=
                       detail::stamp_difference(poses[i].stamp_ns, stamp_ns);
  return earlier ? i - 1 : i;
}

// Between the neighbouring poses: what the trajectory itself says about the motion during the sweep.
Vector6d SweepPoses::twist(std::size_t i) const {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = std::min(i + 1, size() - 1);
  return twist(before, after,
               detail::seconds_between(file_.trajectory[before].stamp_ns, file_.trajectory[after].stamp_ns));
}

// The same by the times of the sweeps, between which others may be missing.
Vector6d SweepPoses::twist(std::size_t i, const SweepWithNeighbours& sweep, double period_s) const {
  const std::size_t before = sweep.before_ns && i > 0 ? i - 1 : i;
  const std::size_t after = sweep.after_ns && i + 1 < size() ? i + 1 : i;
  const std::int64_t begin_ns = before < i ? *sweep.before_ns : sweep.middle_ns;
  const std::int64_t end_ns = after > i ? *sweep.after_ns : sweep.middle_ns;
  const double dt_s = detail::seconds_between(begin_ns, end_ns);
  // Stamps that stand still or go back say nothing.
  return twist(before, after, dt_s > 0 ? dt_s : static_cast<double>(after - before) * period_s);
}

Vector6d SweepPoses::twist(std::size_t before, std::size_t after, double dt_s) const {
  if (before == after) return Vector6d::Zero();
  return se3_log(file_.trajectory[before].T_odom_lidar.inverse() * file_.trajectory[after].T_odom_lidar) / dt_s;
}

std::string SweepPoses::protocol() const {
  return by_stamp_ ? fmt::format("paired by stamp, at most {} s apart", max_gap_s_) : "paired by index";
}

std::vector<Eigen::Vector3f> points_at(const Sweep& sweep, const SweepPose& pose) {
  if (sweep.times_s.empty()) return sweep.points;
  const float middle = middle_s(sweep);
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
