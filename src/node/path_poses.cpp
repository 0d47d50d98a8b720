#include "node/path_poses.hpp"

#include <algorithm>
#include <utility>

namespace rilo {
namespace {

constexpr double kFirstLeastM = 0.05;

}  // namespace

void PathPoses::add(const StampedPose& pose) {
  newest_.reset();
  if (is_next(pose)) {
    kept_.push_back(pose);
  } else {
    newest_ = pose;
  }
  while (kept_.size() >= kMost) thin();
}

Trajectory PathPoses::poses() const {
  Trajectory poses = kept_;
  if (newest_) poses.push_back(*newest_);
  return poses;
}

bool PathPoses::is_next(const StampedPose& pose) const {
  const auto position = [](const StampedPose& p) { return p.T_odom_lidar.translation(); };
  return kept_.empty() || (position(pose) - position(kept_.back())).norm() >= least_m_;
}

void PathPoses::thin() {
  least_m_ = std::max(kFirstLeastM, 2 * least_m_);
  Trajectory all;
  std::swap(all, kept_);
  for (const StampedPose& pose : all) {
    if (is_next(pose)) kept_.push_back(pose);
  }
  if (!newest_ && kept_.back().stamp_ns != all.back().stamp_ns) newest_ = all.back();
}

}  // namespace rilo
