// Which directions of a pose a sweep leaves unconstrained.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Eigen-decomposition of a pose's information with rotations about the centre of what is seen, measured in metres at a
/// lever arm: relative eigenvalues transfer between sensors, places and mountings where absolute ones do not.
struct PoseDegeneracy {
  Vector6d relative_eigenvalues =
      Vector6d::Zero();  ///< ascending, the largest is 1; all zero when there is no information
  Matrix6d directions =
      Matrix6d::Identity();  ///< column i: unit direction of eigenvalue i, [rotation · lever arm; motion of the centre]
  double lever_arm_m = 1.0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< from the sensor, axes of the odometry frame

  /// Perturbation [rotation; translation] of the sensor from one in the coordinates of `directions`.
  Matrix6d to_sensor() const;
  /// The block of the translations of directions · relative_eigenvalues · directionsᵀ.
  Eigen::Matrix3d translation_evidence() const;
};

/// `H`: information (or Hessian) of [rotation; translation] about the sensor. The centre is the one about which
/// rotations are seen least, so that a sensor that looks ahead does not take turning for a motion to the side; the
/// lever arm is chosen such that mean rotation and mean translation weigh the same. `noise`: the part of `H` that comes
/// from errors alone; it is subtracted before the decomposition.
PoseDegeneracy analyse_degeneracy(const Matrix6d& H, const Matrix6d& noise = Matrix6d::Zero());

/// Matrix W (6×6; Hessian Wᵀ H W, gradient Wᵀ Wᵀ b) that fades out the directions whose relative eigenvalue
/// is small against `threshold`: eigenvalue λ keeps the share r⁴ / (r⁴ + 1), r = 2 λ / threshold − 1, none
/// at all below half of the threshold. Identity when `threshold` is 0.
Matrix6d soft_selection(const PoseDegeneracy& degeneracy, double threshold);

}  // namespace rilo
