// A constant error of the sensor's elevation angles, observed through the map.
//
// A point moves with the elevation angle δ by its Jacobian, a plane of the map by the mean Jacobian of its points, and
// both also because the poses at which they were registered depend on δ. What no pose explains – ground seen from afar
// and then from near by, ahead and behind – determines δ. It is one unknown for all sweeps: pose and velocity of each
// are eliminated by the Schur complement, their dependence on δ goes into the map with the points, and the remaining
// information adds up.
#pragma once

#include <cstddef>

#include "registration/adaptive_icp.hpp"
#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Contribution of one sweep to the estimate of a change of δ, at its registered pose.
struct ElevationInformation {
  double information = 0;  ///< 1/rad², pose and velocity eliminated
  double gradient = 0;     ///< 1/rad; the change is gradient / information
  double jacobian_m = 0;   ///< root mean square of ∂residual/∂δ that no pose explains (m/rad)
  PoseDerivative pose;     ///< derivative of the registered pose with respect to δ
};

/// Uses every `stride`-th point of a registered sweep. `last`: derivative of the pose before with respect to δ.
ElevationInformation elevation_information(const TimedCloud& source, const LocalMap& map, const IcpResult& icp,
                                           double sigma_th_m, const AdaptiveIcpConfig& config,
                                           const PoseDerivative& last, std::size_t stride);

/// δ over all sweeps so far.
class ElevationOffsetEstimator {
 public:
  explicit ElevationOffsetEstimator(const ElevationOffsetConfig& config);

  /// Adds a sweep that was registered with `applied_rad()` added to its elevation angles.
  void add(const ElevationInformation& sweep);

  /// Estimate of the angle to add to the sensor's elevation angles, and its standard deviation: of the sweeps, and of
  /// other recordings unless the sweeps contradict. The applied angle and infinite before there are enough sweeps.
  AngleEstimate estimate() const;
  /// Angle added so far.
  double applied_rad() const { return applied_rad_; }

  /// Lets the applied angle follow the estimate once that has differed significantly from zero or from the configured
  /// angle. Returns the change of the applied angle.
  double advance();

  /// The angle to begin with in another run: the estimate if that is certain, else the one that this run began with.
  double known_deg() const;

  /// Forgets the sweeps; `initial_deg` is applied from now on, in place of the configured angle. `others`: what other
  /// recordings say.
  void begin_with(double initial_deg, const AngleEstimate& others);

  /// What begin_with() was told, unless the sweeps contradict.
  const AngleEstimate& others() const { return others_; }

 private:
  AngleEstimate of_sweeps() const;
  double sigma_of_sweeps_rad() const;
  void doubt_others();
  void decide();

  ElevationOffsetConfig config_;
  AngleEstimate others_;
  double applied_rad_ = 0;
  bool following_ = false;
  std::size_t sweeps_ = 0;
  double information_ = 0;
  double weighted_offset_ = 0;
  // Sums over finished blocks: information, its product with the offset and with its square.
  std::size_t blocks_ = 0;
  double jacobian2_ = 0;
  double block_information_ = 0;
  double block_offset_ = 0;
  double squares_ = 0;
  double squared_information_ = 0;
  std::size_t in_block_ = 0;
};

}  // namespace rilo
