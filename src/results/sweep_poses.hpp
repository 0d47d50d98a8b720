// Poses from a file, for the sweeps they belong to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "results/pose_files.hpp"
#include "rilo/cloud/sweep.hpp"

namespace rilo {

/// Pose of the LiDAR at the middle of a sweep, and how it moves then.
struct SweepPose {
  SE3 T = SE3::Identity();
  Vector6d twist = Vector6d::Zero();  ///< body velocity [rad/s; m/s]
};

/// Looks up the poses of sweeps by index or by stamp.
class SweepPoses {
 public:
  /// @throws RunError when stamps are wanted and there are none, or are there and do not increase.
  SweepPoses(PoseFile file, const PairingOptions& options);

  /// Of the sweep that was read as number `index`; nothing when it has none.
  std::optional<SweepPose> of(const Sweep& sweep, std::size_t index, double period_s) const;

  /// Whether no sweep from `index` on has a pose.
  bool end(std::size_t index) const { return !by_stamp_ && index >= size(); }

  std::size_t size() const { return file_.trajectory.size(); }
  std::string protocol() const;

 private:
  std::size_t nearest(std::int64_t stamp_ns) const;
  Vector6d twist(std::size_t i, double period_s) const;

  PoseFile file_;
  double max_gap_s_;
  bool by_stamp_;
};

/// The points of `sweep` as if all were measured at the time of its pose. Untimed ones are so already.
std::vector<Eigen::Vector3f> points_at(const Sweep& sweep, const SweepPose& pose);

}  // namespace rilo
