// Which directions of a pose a sweep leaves unconstrained.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Eigen-decomposition of a pose's information with rotations measured in metres at a lever arm: relative eigenvalues
/// transfer between sensors and places where absolute ones do not.
struct PoseDegeneracy {
  Vector6d relative_eigenvalues =
      Vector6d::Zero();  ///< ascending, the largest is 1; all zero when there is no information
  Matrix6d directions =
      Matrix6d::Identity();  ///< column i: unit direction of eigenvalue i, [rotation · lever arm; translation]
  double lever_arm_m = 1.0;

  /// The block of the translations of directions · relative_eigenvalues · directionsᵀ.
  Eigen::Matrix3d translation_evidence() const;
};

/// `H`: information (or Hessian) of [rotation; translation] about the sensor; the lever arm is chosen such that mean
/// rotation and mean translation weigh the same. `noise`: the part of it that comes from errors alone;
/// it is subtracted first.
PoseDegeneracy analyse_degeneracy(const Matrix6d& H, const Matrix6d& noise = Matrix6d::Zero());

/// Matrix W (6×6; Hessian Wᵀ H W, gradient Wᵀ Wᵀ b) that fades out the directions whose relative eigenvalue
/// is small against `threshold`: eigenvalue λ keeps the share r⁴ / (r⁴ + 1), r = 2 λ / threshold − 1, none
/// at all below half of the threshold. Identity when `threshold` is 0.
Matrix6d soft_selection(const PoseDegeneracy& degeneracy, double threshold);

}  // namespace rilo
