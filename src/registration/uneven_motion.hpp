// Motion within a sweep that deviates from the one its points are compensated for, from the residuals.
#pragma once

#include <cstddef>

#include "cloud/timed_cloud.hpp"
#include "map/local_map.hpp"
#include "registration/adaptive_icp.hpp"

namespace rilo {

/// The sweep is cut into short stretches of time, and each is registered on its own, by one step from the registered
/// pose. How far these poses scatter about it beyond what their own noise explains, squared: [rad²; m²], axes of the
/// sensor. Zero for a source without times, and along what a stretch does not see.
/// @param source the registered sweep (m, sensor frame, s).
/// @param map the map that it was registered to.
/// @param icp result of the registration: pose and velocity.
/// @param sigma_th_m scale of the weights, as in the registration.
/// @param config of the registration: gate and least noise.
/// @param noise_share share of the residuals that count as independent.
/// @param stride only every `stride`-th point is used.
Vector6d uneven_motion(const TimedCloud& source, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
                       const AdaptiveIcpConfig& config, double noise_share, std::size_t stride);

}  // namespace rilo
