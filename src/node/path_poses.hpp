// The path of a run of any length, with a bounded number of poses.
#pragma once

#include <cstddef>
#include <optional>

#include "rilo/geometry/trajectory.hpp"

namespace rilo {

/// Keeps every pose until there are kMost; then, and each time that they are as many again, the poses that are nearer
/// than a least distance to the one kept before them are left out, and that distance doubles. The first and the newest
/// pose are always there.
class PathPoses {
 public:
  static constexpr std::size_t kMost = 10'000;  // a message of 720 kB

  void add(const StampedPose& pose);

  Trajectory poses() const;

 private:
  bool is_next(const StampedPose& pose) const;
  void thin();

  Trajectory kept_;
  std::optional<StampedPose> newest_;  // where it is not the last one kept
  double least_m_ = 0;
};

}  // namespace rilo
