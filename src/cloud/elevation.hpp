// Derivative of a point with respect to the elevation angle of its beam.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace rilo {

/// Derivative of a point (sensor frame, m) with respect to its elevation angle (m/rad), at constant range and azimuth.
/// Zero on the axis.
inline Eigen::Vector3f elevation_jacobian(const Eigen::Vector3f& p) {
  const float horizontal = std::sqrt(p.x() * p.x() + p.y() * p.y());
  if (!(horizontal > 0.0F)) {
    return Eigen::Vector3f::Zero();
  }
  const float tangent = p.z() / horizontal;
  return {-tangent * p.x(), -tangent * p.y(), horizontal};
}

/// Rotates points by an angle in the vertical plane through each and the sensor's axis. Points on the axis stay.
class ElevationRotation {
 public:
  explicit ElevationRotation(double angle_rad)
      : cosine_(static_cast<float>(std::cos(angle_rad))), sine_(static_cast<float>(std::sin(angle_rad))) {}

  float cosine() const { return cosine_; }
  float sine() const { return sine_; }

  Eigen::Vector3f operator()(const Eigen::Vector3f& p) const { return cosine_ * p + sine_ * elevation_jacobian(p); }

 private:
  float cosine_;
  float sine_;
};

}  // namespace rilo
