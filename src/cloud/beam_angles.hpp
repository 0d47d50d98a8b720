// Small corrections of the angles of single beams.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud/beam_index.hpp"
#include "cloud/elevation.hpp"

namespace rilo {

/// Derivative of a point (sensor frame, m) with respect to its azimuth (m/rad).
inline Eigen::Vector3f azimuth_jacobian(const Eigen::Vector3f& p) { return {-p.y(), p.x(), 0.0F}; }

/// Angles to add to those of each beam. Small: points move along the tangents.
class BeamAngles {
 public:
  /// Elevation and azimuth of a beam, below kBeams (rad).
  Eigen::Vector2f& at(Beam beam) { return angles_rad_[beam]; }
  /// The same; zero for points of no beam.
  Eigen::Vector2f of(Beam beam) const { return beam < kBeams ? angles_rad_[beam] : Eigen::Vector2f(0.0F, 0.0F); }

  /// The point (sensor frame, m) as it would be at the right angles.
  Eigen::Vector3f corrected(const Eigen::Vector3f& p, Beam beam) const {
    const Eigen::Vector2f angles = of(beam);
    return p + angles.x() * elevation_jacobian(p) + angles.y() * azimuth_jacobian(p);
  }

 private:
  std::vector<Eigen::Vector2f> angles_rad_ = std::vector<Eigen::Vector2f>(kBeams, Eigen::Vector2f::Zero());
};

}  // namespace rilo
