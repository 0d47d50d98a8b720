// What tells one optimum of a registration from another.
#pragma once

#include "registration/adaptive_icp.hpp"
#include "registration/closeness.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// What fits over how far it is off (1/m): score times the share of points close to a plane over their distance.
inline double quality_of(const Closeness& closeness, double score) {
  return closeness.rms_m > 0.0 ? score * closeness.share / closeness.rms_m : 0.0;
}

/// Whether that is less than right sweeps have that fit as those before them did.
inline bool suspicious(double quality, double usual_quality) {
  constexpr double kUsualShare = 0.85;
  return quality < kUsualShare * usual_quality;
}

/// Converged without points that had to be held.
inline bool settled(const IcpResult& icp) { return icp.converged() && !icp.frozen; }

/// In another basin: half the width of that of an optimum on a road.
inline bool elsewhere(const SE3& a, const SE3& b) {
  constexpr double kApartM = 0.625;
  constexpr double kApartRad = 0.1;
  const SE3 between = a.inverse() * b;
  return between.translation().norm() > kApartM || rotation_angle_rad(between) > kApartRad;
}

}  // namespace rilo
