// Sweeps of another time: missing or reordered ones lie elsewhere on the path, where a sample of them stands out.
#pragma once

#include <vector>

#include "odometry/pose_search.hpp"

namespace rilo {

/// Searches whole periods earlier and later along the predicted motion; the parts and the search outlive it.
class PathSearch {
 public:
  PathSearch(const RegistrationParts& parts, const PoseSearch& search) : parts_(parts), search_(search) {}

  /// Replaces `found` where the sweep stands out elsewhere on the path and settles there. Where it does not settle,
  /// `found` is ambiguous.
  void improve(const MotionState& predicted, Registration& found) const;

 private:
  std::vector<SampleFit> fits_on_path(const MotionState& predicted, const Deadline& end) const;

  const RegistrationParts& parts_;
  const PoseSearch& search_;
};

}  // namespace rilo
