#include "registration/degeneracy.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace rilo {

Eigen::Matrix3d PoseDegeneracy::translation_evidence() const {
  const auto rows = directions.bottomRows<3>();
  return rows * relative_eigenvalues.asDiagonal() * rows.transpose();
}

PoseDegeneracy analyse_degeneracy(const Matrix6d& H, const Matrix6d& noise) {
  PoseDegeneracy result;
  const double rotation = H.topLeftCorner<3, 3>().trace();
  const double translation = H.bottomRightCorner<3, 3>().trace();
  if (!(translation > 0.0) || !(rotation > 0.0) || !H.allFinite()) {
    return result;
  }
  result.lever_arm_m = std::sqrt(rotation / translation);
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(1.0 / result.lever_arm_m);
  const Matrix6d scaled = scale.asDiagonal() * (H - noise) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
  const double largest = solver.eigenvalues()[5];
  if (largest > 0.0) {
    result.relative_eigenvalues = solver.eigenvalues().cwiseMax(0.0) / largest;
    result.directions = solver.eigenvectors();
  }
  return result;
}

Matrix6d soft_selection(const PoseDegeneracy& degeneracy, double threshold) {
  if (threshold <= 0.0) {
    return Matrix6d::Identity();
  }
  // Nothing at all below half of the threshold: what is known of the motion fades from sweep to sweep in a direction
  // that is not seen, and then the least share of noise would rule it.
  const double half = 0.5 * threshold;
  const Eigen::Array<double, 6, 1> power = (degeneracy.relative_eigenvalues.array() - half).max(0.0).pow(4);
  // W is applied from both sides, so that it carries the square root of the share.
  const Vector6d share = (power / (power + std::pow(half, 4))).sqrt();
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(degeneracy.lever_arm_m);
  const Matrix6d& V = degeneracy.directions;
  // V S Vᵀ acts on perturbations in metres; the scales carry it to radians and metres.
  const Matrix6d W = V * share.asDiagonal() * V.transpose();
  return scale.cwiseInverse().asDiagonal() * W * scale.asDiagonal();
}

}  // namespace rilo
