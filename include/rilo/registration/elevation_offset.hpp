// A constant error of the sensor's elevation angles, observed through the map.
//
// A point moves with the elevation angle δ by its lever, the map's plane by the mean lever of the points that made it,
// and both also because the poses they were registered at depend on δ. What no pose explains – ground seen from far and
// then from near, before and behind – tells δ. One unknown for all sweeps: the pose and velocity of each are eliminated
// by the Schur complement, their dependence on δ goes into the map with the points, and what is left adds up.
#pragma once

#include <cstddef>

#include "rilo/registration/adaptive_icp.hpp"
#include "rilo/registration/elevation_offset_config.hpp"

namespace rilo {

/// What one sweep says about a change of δ at its registered pose.
struct ElevationInformation {
  double information = 0;  ///< 1/rad², pose and velocity eliminated
  double gradient = 0;     ///< 1/rad; the change is gradient / information
  double lever_m = 0;      ///< root mean square of what δ does to a residual and no pose explains (m/rad)
  RigidLever pose;         ///< how the registered pose moves with δ, per rad
};

/// Looks at every `stride`-th point of a registered sweep. `last`: how the pose before moves with δ.
ElevationInformation elevation_information(const TimedCloud& source, const LocalMap& map, const IcpResult& icp,
                                           double sigma_th_m, const AdaptiveIcpConfig& config, const RigidLever& last,
                                           std::size_t stride);

/// δ over all sweeps so far.
class ElevationOffsetEstimator {
 public:
  explicit ElevationOffsetEstimator(const ElevationOffsetConfig& config);

  /// Adds a sweep that was registered with `applied_rad()` added to its elevation angles.
  void add(const ElevationInformation& sweep);

  /// Estimate of the angle to add to the sensor's elevation angles; the configured one before any sweep.
  double offset_rad() const;
  /// Its standard deviation, from the scatter of blocks of sweeps; infinite before there are enough.
  double sigma_rad() const;
  /// Angle added so far.
  double applied_rad() const { return applied_rad_; }

  /// Follows the estimate from when it is certain to differ from nothing or from what was known beforehand; takes the
  /// correction back when it is not known any more that there is an error. Returns the change of the applied angle.
  double advance();

  void reset() { *this = ElevationOffsetEstimator(config_); }

 private:
  void decide();

  ElevationOffsetConfig config_;
  double applied_rad_ = 0;
  bool following_ = false;
  std::size_t sweeps_ = 0;
  double information_ = 0;
  double weighted_offset_ = 0;
  // Sums over finished blocks: information, its product with the offset and with its square.
  std::size_t blocks_ = 0;
  double lever2_ = 0;
  double block_information_ = 0;
  double block_offset_ = 0;
  double squares_ = 0;
  double squared_information_ = 0;
  std::size_t in_block_ = 0;
};

}  // namespace rilo
