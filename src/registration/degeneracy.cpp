#include "registration/degeneracy.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace rilo {

namespace {
constexpr double kLeastArm = 1e-6;  // of the trace: where all normals are parallel, a centre along them means nothing

/// H_rt = Σ β [q]× N about the sensor, N = n nᵀ. About c = (tr ΣβN − ΣβN)⁻¹ Σβ (tr N − N) q it is symmetric and the
/// trace of the rotations least.
Eigen::Vector3d centre_of(const Matrix6d& H) {
  const Eigen::Matrix3d N = H.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d skew = H.topRightCorner<3, 3>() - H.bottomLeftCorner<3, 3>();
  const Eigen::Matrix3d across = (1.0 + kLeastArm) * N.trace() * Eigen::Matrix3d::Identity() - N;
  return across.ldlt().solve(Eigen::Vector3d(skew(2, 1), skew(0, 2), skew(1, 0)));
}
}  // namespace

Matrix6d PoseDegeneracy::to_sensor() const {
  Matrix6d S = adjoint(SE3(Eigen::Translation3d(centre_m)));
  S.leftCols<3>() /= lever_arm_m;
  return S;
}

Eigen::Matrix3d PoseDegeneracy::translation_evidence() const {
  const auto rows = directions.bottomRows<3>();
  return rows * relative_eigenvalues.asDiagonal() * rows.transpose();
}

PoseDegeneracy analyse_degeneracy(const Matrix6d& H, const Matrix6d& noise) {
  const double translation = H.bottomRightCorner<3, 3>().trace();
  if (!(translation > 0.0) || !H.allFinite()) {
    return {};
  }
  PoseDegeneracy result;
  result.centre_m = centre_of(H);
  const Matrix6d to_centre = result.to_sensor();
  const double rotation = (to_centre.transpose() * H * to_centre).topLeftCorner<3, 3>().trace();
  if (!(rotation > 0.0)) {
    return {};
  }
  result.lever_arm_m = std::sqrt(rotation / translation);
  const Matrix6d S = result.to_sensor();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(S.transpose() * (H - noise) * S);
  const double largest = solver.eigenvalues()[5];
  if (!(largest > 0.0)) {
    return {};
  }
  result.relative_eigenvalues = solver.eigenvalues().cwiseMax(0.0) / largest;
  result.directions = solver.eigenvectors();
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
  const Matrix6d& V = degeneracy.directions;
  // The shares act on perturbations in metres about the centre.
  const Matrix6d S = degeneracy.to_sensor();
  return S * V * share.asDiagonal() * V.transpose() * S.inverse();
}

}  // namespace rilo
