// Normal equations of scalar residuals on a pose and on the velocity during a sweep.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// For six unknowns, with something to spare.
inline constexpr std::size_t kLeastCorrespondences = 10;

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

/// Lower triangle of a symmetric 6×6 matrix, column by column. Columns begin at even rows, so that they are whole pairs
/// of doubles; what that adds above the diagonal is not read.
using PackedSymmetric6 = Eigen::Matrix<double, 24, 1>;

/// (w J) Jᵀ.
inline PackedSymmetric6 packed_product(const Vector6d& wJ, const Vector6d& J) {
  PackedSymmetric6 h;
  h.segment<6>(0) = wJ * J[0];
  h.segment<6>(6) = wJ * J[1];
  h.segment<4>(12) = wJ.tail<4>() * J[2];
  h.segment<4>(16) = wJ.tail<4>() * J[3];
  h.segment<2>(20) = wJ.tail<2>() * J[4];
  h.segment<2>(22) = wJ.tail<2>() * J[5];
  return h;
}

/// Of the lower triangle of `m`.
inline PackedSymmetric6 packed(const Matrix6d& m) {
  PackedSymmetric6 h;
  h << m.col(0), m.col(1), m.col(2).tail<4>(), m.col(3).tail<4>(), m.col(4).tail<2>(), m.col(5).tail<2>();
  return h;
}

/// Sums of weighted residuals e with Jacobian [J, s J], s the offset (s) of the point from the time of the pose, or the
/// lever of the velocity at that offset: the second block is the velocity. The three blocks of the Hessian share the
/// products J Jᵀ, so that a velocity costs little more than none.
struct NormalEquations {
  PackedSymmetric6 H0 = PackedSymmetric6::Zero();  ///< Σ w J Jᵀ
  PackedSymmetric6 H1 = PackedSymmetric6::Zero();  ///< Σ w s J Jᵀ
  PackedSymmetric6 H2 = PackedSymmetric6::Zero();  ///< Σ w s² J Jᵀ
  Vector6d b0 = Vector6d::Zero();                  ///< Σ w J e
  Vector6d b1 = Vector6d::Zero();                  ///< Σ w s J e
  double weight = 0;                               ///< Σ w
  double squared_error = 0;                        ///< Σ w e²
  std::size_t count = 0;                           ///< residuals

  void add(const Vector6d& J, double e, double w) {
    const Vector6d wJ = w * J;
    H0 += packed_product(wJ, J);
    b0 += e * wJ;
    weight += w;
    squared_error += w * e * e;
    ++count;
  }

  void add(const Vector6d& J, double e, double w, double s) {
    const Vector6d wJ = w * J;
    add_products(packed_product(wJ, J), s);
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
    add_products(packed(jacobian_moment(q, M)), s);
    Vector6d b;
    b << q.cross(g), g;
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

 private:
  void add_products(const PackedSymmetric6& h, double s) {
    H0 += h;
    H1 += s * h;
    H2 += s * s * h;
  }
};

}  // namespace rilo
