// Normal equations of scalar residuals on a pose and on the velocity during a sweep.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Lower triangle of Σ J Jᵀ over directions d with J = [(q × d)ᵀ dᵀ] and M = Σ d dᵀ.
inline Matrix6d jacobian_moment(const Eigen::Vector3d& q, const Eigen::Matrix3d& M) {
  Matrix6d h = Matrix6d::Zero();
  for (int c = 0; c < 3; ++c) {
    h.block<1, 3>(3 + c, 0) = q.cross(M.col(c)).transpose();
    h.block<3, 1>(3, 3 + c) = M.col(c);
  }
  for (int c = 0; c < 3; ++c) {
    h.block<3, 1>(0, c) = q.cross(h.block<3, 1>(3, c));
  }
  return h;
}

/// Sums of weighted residuals e with Jacobian [J, s J], s the offset (s) of the point from the time of the pose: the
/// second block is the velocity. The three blocks of the Hessian share the products J Jᵀ, so that a velocity costs
/// little more than none.
struct NormalEquations {
  Matrix6d H0 = Matrix6d::Zero();  ///< Σ w J Jᵀ, lower triangle
  Matrix6d H1 = Matrix6d::Zero();  ///< Σ w s J Jᵀ
  Matrix6d H2 = Matrix6d::Zero();  ///< Σ w s² J Jᵀ
  Vector6d b0 = Vector6d::Zero();  ///< Σ w J e
  Vector6d b1 = Vector6d::Zero();  ///< Σ w s J e
  double weight = 0;               ///< Σ w
  double squared_error = 0;        ///< Σ w e²
  std::size_t count = 0;           ///< residuals

  void add(const Vector6d& J, double e, double w) {
    const Vector6d wJ = w * J;
    for (int c = 0; c < 6; ++c) {
      for (int r = c; r < 6; ++r) {
        H0(r, c) += wJ[r] * J[c];
      }
    }
    b0 += e * wJ;
    weight += w;
    squared_error += w * e * e;
    ++count;
  }

  void add(const Vector6d& J, double e, double w, double s) {
    const Vector6d wJ = w * J;
    for (int c = 0; c < 6; ++c) {
      for (int r = c; r < 6; ++r) {
        const double h = wJ[r] * J[c];
        H0(r, c) += h;
        H1(r, c) += s * h;
        H2(r, c) += s * s * h;
      }
    }
    b0 += e * wJ;
    b1 += s * e * wJ;
    weight += w;
    squared_error += w * e * e;
    ++count;
  }

  /// Adds residuals of one point along several directions at once: J = [(q × d)ᵀ dᵀ] for each direction d, with
  /// M = Σ w d dᵀ, g = Σ w e d over them, `w` = Σ w, `we2` = Σ w e² and `n` how many there are.
  void add(const Eigen::Vector3d& q, const Eigen::Matrix3d& M, const Eigen::Vector3d& g, double w, double we2,
           std::size_t n, double s) {
    const Matrix6d h = jacobian_moment(q, M);
    Vector6d b;
    b << q.cross(g), g;
    for (int c = 0; c < 6; ++c) {
      for (int r = c; r < 6; ++r) {
        H0(r, c) += h(r, c);
        H1(r, c) += s * h(r, c);
        H2(r, c) += s * s * h(r, c);
      }
    }
    b0 += b;
    b1 += s * b;
    weight += w;
    squared_error += we2;
    count += n;
  }

  NormalEquations& operator+=(const NormalEquations& other);

  /// Symmetric 6×6 Hessian of the pose.
  Matrix6d pose_hessian() const;
  /// Symmetric 12×12 Hessian of pose and velocity.
  Matrix12d hessian() const;
  /// Gradient of pose and velocity.
  Vector12d gradient() const;
};

}  // namespace rilo
