// Registering a sweep from several places where one start may not do.
#pragma once

#include "odometry/registration.hpp"

namespace rilo {

/// Searches the pose of one sweep; its state is that of the context, which outlive it.
class PoseSearch {
 public:
  /// Of the time left; after a loss, what was found has to hold in the rest of it.
  static constexpr double kTimeShare = 0.7;

  explicit PoseSearch(const RegistrationContext& context);

  /// When the search ends.
  const Deadline& end() const { return end_; }
  /// For registrations that start where no velocity is known.
  const AdaptiveIcpConfig& icp() const { return icp_; }

  /// All points of the sweep, registered to the map from a start.
  Registration to_map(const MotionState& start, const MotionPrior& prior, double sigma_th_m,
                      const AdaptiveIcpConfig& icp, const Deadline& deadline) const;
  /// The same from where the motion so far does not count, until the search ends; with the present threshold or a wider
  /// one.
  Registration from(const MotionState& start, double least_sigma_th_m = 0.0) const;
  /// Score and quality of a registration to a map.
  void rate(Registration& found, const LocalMap& map) const;

  /// A map of this sweep alone in a state, or of some of its points.
  LocalMap map_of(const TimedCloud& cloud, const MotionState& state) const;

 private:
  void narrow(Registration& found, const MotionPrior& prior, AdaptiveIcpConfig icp, const Deadline& deadline) const;

  const RegistrationContext& context_;
  Deadline end_;
  AdaptiveIcpConfig icp_;
};

}  // namespace rilo
