// Registering a sweep from several places where one start may not do, and which result is kept.
#pragma once

#include "odometry/registration.hpp"

namespace rilo {

/// Where a sample of a sweep comes to rest from a start, and how well it fits there.
struct SampleFit {
  MotionState state;
  double quality = 0;  ///< 0: not tried
};

/// Searches the pose of one sweep; its state is that of the parts, which outlive it.
class PoseSearch {
 public:
  /// Of the time left; after a loss, what was found has to hold in the rest of it.
  static constexpr double kTimeShare = 0.7;

  explicit PoseSearch(const RegistrationParts& parts);

  /// When the search ends.
  const Deadline& end() const { return end_; }
  /// For registrations that start where no velocity is known.
  const AdaptiveIcpConfig& icp() const { return icp_; }

  /// All points of the sweep, registered to the map from a start.
  Registration to_map(const MotionState& start, const MotionPrior& prior, double sigma_th_m,
                      const AdaptiveIcpConfig& icp, const Deadline& deadline) const;
  /// Score and quality of a registration to a map.
  void rate(Registration& found, const LocalMap& map) const;
  /// Some of the points, registered to a map from a start.
  SampleFit fit_of(const TimedCloud& sample, const MotionState& start, const LocalMap& map,
                   const Deadline& deadline) const;
  /// Replaces `found` by the result of a further start that ends elsewhere and fits clearly better, or settles where
  /// `found` did not.
  void keep_better(Registration other, Registration& found) const;

 private:
  const RegistrationParts& parts_;
  Deadline end_;
  AdaptiveIcpConfig icp_;
};

}  // namespace rilo
