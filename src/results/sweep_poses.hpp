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

/// The middle of the sweep.
std::int64_t middle_ns(const Sweep& sweep);

/// When a sweep and those around it were measured.
struct SweepWithNeighbours {
  std::size_t index = 0;  ///< it was read as number `index`
  std::int64_t middle_ns = 0;
  std::optional<std::int64_t> before_ns, after_ns;  ///< the middles of the sweeps before and after it
};

/// Looks up the poses of sweeps by index or by stamp.
class SweepPoses {
 public:
  /// @throws RunError when stamps are wanted and there are none, or are there and do not increase.
  SweepPoses(PoseFile file, const PairingOptions& options);

  /// Nothing when the sweep has none.
  std::optional<SweepPose> of(const SweepWithNeighbours& sweep, double period_s) const;

  /// Whether no sweep from `index` on has a pose.
  bool end(std::size_t index) const { return !by_stamp_ && index >= size(); }

  bool by_stamp() const { return by_stamp_; }
  std::size_t size() const { return file_.trajectory.size(); }
  std::string protocol() const;

 private:
  std::size_t nearest(std::int64_t stamp_ns) const;
  Vector6d twist(std::size_t i) const;
  Vector6d twist(std::size_t i, const SweepWithNeighbours& sweep, double period_s) const;
  Vector6d twist(std::size_t before, std::size_t after, double dt_s) const;

  PoseFile file_;
  double max_gap_s_;
  bool by_stamp_;
};

/// The points of `sweep` as if all were measured at the time of its pose. Untimed ones are so already.
std::vector<Eigen::Vector3f> points_at(const Sweep& sweep, const SweepPose& pose);

}  // namespace rilo
