// The second sweep of a map: with it the velocity of the first is found, too.
#pragma once

#include <optional>
#include <vector>

#include "odometry/pose_search.hpp"

namespace rilo {

/// Registers it from the initial pose and from other places where no motion is known yet; the parts and the search
/// outlive it.
class SecondSweep {
 public:
  SecondSweep(const RegistrationParts& parts, const PoseSearch& search);

  Registration registered(const MotionState& start, const MotionPrior& prior) const;

 private:
  Registration in_rounds(const MotionState& start, const MotionPrior& first_prior, int rounds) const;
  std::vector<MotionState> other_starts(const Registration& found) const;
  std::optional<LocalMap> of_first_sweep(const TimedCloud& first, const Vector6d& twist) const;
  const LocalMap& or_present(const std::optional<LocalMap>& compensated) const;
  Vector6d twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const;

  const RegistrationParts& parts_;
  const PoseSearch& search_;
  // A share of the points of both sweeps, for all registrations but the last of a start.
  TimedCloud source_;
  TimedCloud map_cloud_;
  TimedCloud first_;  // of the map cloud of the first sweep
};

}  // namespace rilo
