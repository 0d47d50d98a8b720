// What one sweep says of a constant error of the sensor's elevation angles, observed through the map.
//
// A point moves with the elevation angle δ by its Jacobian, a plane of the map by the mean Jacobian of its points, and
// both also because the poses at which they were registered depend on δ. What no pose explains – ground seen from afar
// and then from near by, ahead and behind – determines δ. It is one unknown for all sweeps: pose and velocity of each
// are eliminated by the Schur complement, their dependence on δ goes into the map with the points, and the remaining
// information adds up.
#pragma once

#include <array>
#include <cstddef>

#include "registration/adaptive_icp.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Beams err one by one: points within a band of elevation angles, as wide as the beams of dense sensors are apart,
/// share an error.
inline constexpr double kBandDeg = 0.4;
inline constexpr std::size_t kBands = 256;  ///< from -51.2° on; the outermost ones take what lies beyond

/// Contribution of one sweep to the estimate of a change of δ, at its registered pose.
struct ElevationInformation {
  double information = 0;  ///< 1/rad², pose and velocity eliminated
  double gradient = 0;     ///< 1/rad; the change is gradient / information
  double jacobian_m = 0;   ///< root mean square of ∂residual/∂δ that no pose explains (m/rad)
  PoseDerivative pose;     ///< derivative of the registered pose with respect to δ
  /// Derivative of the gradient with respect to an error of the points of each band alone (1/rad²).
  std::array<double, kBands> by_band = {};
};

/// Uses every `stride`-th point of a registered sweep. `last`: derivative of the pose before with respect to δ.
ElevationInformation elevation_information(const TimedCloud& source, const LocalMap& map, const IcpResult& icp,
                                           double sigma_th_m, const AdaptiveIcpConfig& config,
                                           const PoseDerivative& last, std::size_t stride);

}  // namespace rilo
