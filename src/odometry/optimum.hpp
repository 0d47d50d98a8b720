// What tells one optimum of a registration from another, and the better of two.
#pragma once

#include <cstddef>

#include "odometry/pose_noise.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// What fits over how far it is off (1/m): score times share of the points that are matched over their residuals. The
/// score sees small differences, the correspondences all points. Comparable within the same gate.
inline double quality_of(const IcpResult& icp, double score, std::size_t points) {
  const double share = static_cast<double>(icp.inliers) / static_cast<double>(points);
  return icp.residual_rms_m > 0.0 ? score * share / icp.residual_rms_m : 0.0;
}

/// Converged without points that had to be held.
inline bool settled(const IcpResult& icp) { return icp.converged() && !icp.frozen; }

/// Converged where `other` did not, or without points that `other` had to hold.
inline bool settles_better(const IcpResult& icp, const IcpResult& other) {
  return (icp.converged() && !other.converged()) || (settled(icp) && !settled(other));
}

inline bool within(const SE3& a, const SE3& b, double metres, double radians) {
  const SE3 between = a.inverse() * b;
  return between.translation().norm() <= metres && rotation_angle_rad(between) <= radians;
}

/// Poses nearer than the noise of good ones: their scores differ by the sample of the score.
inline bool same_optimum(const SE3& a, const SE3& b) { return within(a, b, kPoseNoiseM, kPoseNoiseRad); }

/// In another basin: half the width of that of an optimum on a road.
inline bool elsewhere(const SE3& a, const SE3& b) {
  constexpr double kApartM = 0.625;
  constexpr double kApartRad = 0.1;
  return !within(a, b, kApartM, kApartRad);
}

}  // namespace rilo
