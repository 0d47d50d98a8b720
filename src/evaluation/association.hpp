// Which pose of the estimate belongs to which true pose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rilo/geometry/trajectory.hpp"

namespace rilo {

/// Two trajectories of equal length; element i of each belongs to the same time.
struct MatchedPoses {
  std::vector<SE3> truth;
  std::vector<SE3> estimate;
  std::vector<std::size_t> estimate_index;  ///< position in the trajectory that was given
};

/// Takes for every estimated pose the true pose nearest in time, no farther than `tolerance_ns`. A true pose is used
/// once, by the estimate nearest to it. Order and gaps of the stamps do not matter; the result is in the order of time.
/// @throws std::invalid_argument when tolerance_ns is negative or fewer than two poses match.
MatchedPoses match_by_stamp(const Trajectory& truth, const Trajectory& estimate, std::int64_t tolerance_ns);

/// Pose i belongs to pose i. @throws std::invalid_argument when the lengths differ or are below two.
MatchedPoses match_by_index(const Trajectory& truth, const Trajectory& estimate);

/// The poses without their stamps.
std::vector<SE3> poses_of(const Trajectory& trajectory);

}  // namespace rilo
