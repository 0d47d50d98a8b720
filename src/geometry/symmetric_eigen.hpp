// Eigen-decomposition of symmetric 3×3 matrices, the way surfaces are read from covariances.
#pragma once

#include <Eigen/Core>

namespace rilo {

/// Eigenvalues ascending; column i of `vectors` is the unit eigenvector of values[i].
struct SymmetricEigen3 {
  Eigen::Vector3d values;
  Eigen::Matrix3d vectors;
};

/// Closed-form decomposition of the symmetric matrix `A` (lower triangle read). Scale-invariant: A is normalised first,
/// so that covariances of mm² and of km² keep the same relative precision (about 1e-8 of the largest eigenvalue).
SymmetricEigen3 symmetric_eigen(const Eigen::Matrix3d& A);

}  // namespace rilo
