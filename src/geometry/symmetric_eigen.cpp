#include "geometry/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace rilo {

SymmetricEigen3 symmetric_eigen(const Eigen::Matrix3d& A) {
  // Eigen's direct solver shifts and scales internally, and falls back to a basis of the null space when eigenvalues
  // coincide.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace rilo
