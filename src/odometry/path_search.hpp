// Sweeps of another time: missing or reordered ones lie elsewhere on the path.
#pragma once

#include <vector>

#include "odometry/pose_search.hpp"
#include "odometry/sweep_overlap.hpp"

namespace rilo {

/// Looks earlier and later along the predicted motion, and where the sweep before fitted, for the place where the sweep
/// has most in common with the last one that was accepted; the context and the search outlive it.
class PathSearch {
 public:
  PathSearch(const RegistrationContext& context, const PoseSearch& search) : context_(context), search_(search) {}

  /// Replaces `found` where the sweep has clearly more in common at another of these places and settles there. Where it
  /// does not settle, `found` is ambiguous. After a loss, it may show that it has more only once it has settled.
  void improve(const MotionState& predicted, Registration& found) const;

 private:
  SweepOverlap overlap_with_last(const MotionState& predicted, const Registration& found) const;
  Registration registered_from(const MotionState& place) const;
  std::vector<MotionState> path_of(const MotionState& predicted) const;

  const RegistrationContext& context_;
  const PoseSearch& search_;
};

}  // namespace rilo
