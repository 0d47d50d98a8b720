// The second sweep of a map: with it the velocity of the first is found, too.
#pragma once

#include <optional>
#include <vector>

#include "odometry/pose_search.hpp"
#include "odometry/sweep_overlap.hpp"

namespace rilo {

/// Registers it from the initial pose and from other places where no motion is known yet; the context and the search
/// outlive it.
class SecondSweep {
 public:
  SecondSweep(const RegistrationContext& context, const PoseSearch& search);

  Registration registered(const MotionState& start, const MotionPrior& prior) const;

 private:
  bool too_late_for_two_rounds() const;
  Registration in_rounds(const MotionState& start, const MotionPrior& first_prior, int rounds) const;
  SweepOverlap overlap_with_first(const Registration& found) const;
  MotionState moved(const MotionState& state, const Eigen::Vector3d& by_m) const;
  double times_asked(const Registration& found) const;
  std::vector<MotionState> places_along(const Registration& found, const Eigen::Vector3d& direction) const;
  std::optional<Registration> more_along(const Eigen::Vector3d& direction, SweepOverlap& overlap, Registration& found,
                                         bool& ambiguous) const;
  void move_to_most_overlap(Registration& found) const;
  std::optional<LocalMap> of_first_sweep(const TimedCloud& first, const Vector6d& twist) const;
  const LocalMap& or_present(const std::optional<LocalMap>& compensated) const;
  Vector6d twist_of_first(const IcpResult& second, double sigma_m, const Deadline& deadline) const;

  const RegistrationContext& context_;
  const PoseSearch& search_;
  // A share of the points of both sweeps, for all registrations but the last of a start.
  TimedCloud source_;
  TimedCloud map_cloud_;
  TimedCloud first_;  // of the map cloud of the first sweep
};

}  // namespace rilo
