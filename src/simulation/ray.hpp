// What is cast, and what it meets.
#pragma once

#include <limits>

#include <Eigen/Core>

namespace rilo::simulation {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit

  Eigen::Vector3d at(double range) const { return origin + range * direction; }
};

/// The nearest surface met so far.
struct Hit {
  double range_m = kInfinity;
  double cos_incidence = 1;  ///< of the angle between the ray and the surface's normal
  double reflectivity = 0;   ///< 0 … 1
  bool glass = false;        ///< answers now and then only

  /// Takes the surface when it is nearer.
  void offer(double range, double cos_angle, double surface_reflectivity, bool is_glass = false) {
    if (range < range_m) *this = {range, cos_angle, surface_reflectivity, is_glass};
  }
};

}  // namespace rilo::simulation
