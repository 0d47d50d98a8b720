// Normal equations of scalar residuals on a pose and on the velocity during a sweep.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// For six unknowns, with something to spare.
inline constexpr std::size_t kLeastCorrespondences = 10;

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

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

/// The same for Σ J Jᵀ over directions d with J = [(q × d)ᵀ dᵀ] and M = Σ d dᵀ.
inline PackedSymmetric6 packed_moment(const Eigen::Vector3d& q, const Eigen::Matrix3d& M) {
  Eigen::Matrix3d A;  // column c: q × M.col(c)
  A << q.cross(M.col(0)), q.cross(M.col(1)), q.cross(M.col(2));
  PackedSymmetric6 h = PackedSymmetric6::Zero();
  h.segment<3>(0) = q.cross(A.row(0));
  h.segment<3>(3) = A.row(0);
  h.segment<3>(6) = q.cross(A.row(1));
  h.segment<3>(9) = A.row(1);
  h[12] = q.x() * A(2, 1) - q.y() * A(2, 0);
  h.segment<3>(13) = A.row(2);
  h.segment<3>(17) = M.col(0);
  h.segment<2>(20) = M.col(1).tail<2>();
  h[23] = M(2, 2);
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

  NormalEquations& operator+=(const NormalEquations& other);

  /// Symmetric 6×6 Hessian of the pose.
  Matrix6d pose_hessian() const;
  /// Symmetric 12×12 Hessian of pose and velocity.
  Matrix12d hessian() const;
  /// Gradient of pose and velocity.
  Vector12d gradient() const;
};

/// Adds residuals to normal equations a block at a time: their sums then stay in registers.
class ResidualBlock {
 public:
  /// `velocity`: false where all s are 0.
  explicit ResidualBlock(NormalEquations& sums, bool velocity = true) : sums_(sums), velocity_(velocity) {}

  void add(const Vector6d& J, double e, double w, double s) {
    Row& row = next();
    row.wJ = w * J;
    row.h = packed_product(row.wJ, J);
    row.e = e;
    row.s = s;
    count(w, w * e * e, 1);
  }

  /// Adds residuals of one point along several directions at once: J = [(q × d)ᵀ dᵀ] for each direction d, with
  /// M = Σ w d dᵀ, g = Σ w e d over them, `w` = Σ w, `we2` = Σ w e² and `n` how many there are.
  void add(const Eigen::Vector3d& q, const Eigen::Matrix3d& M, const Eigen::Vector3d& g, double w, double we2,
           std::size_t n, double s) {
    Row& row = next();
    row.wJ << q.cross(g), g;
    row.h = packed_moment(q, M);
    row.e = 1.0;
    row.s = s;
    count(w, we2, n);
  }

  /// Adds what has been gathered; afterwards the sums are complete.
  void flush();

 private:
  struct Row {
    PackedSymmetric6 h;  // w J Jᵀ
    Vector6d wJ;
    double e = 0;
    double s = 0;
  };
  static constexpr std::size_t kRows = 32;  // 8 kB: they stay in the nearest cache
  static void sum(const Row* rows, std::size_t n, bool velocity, NormalEquations& sums);

  Row& next() {
    if (used_ == kRows) {
      flush();
    }
    return rows_[used_++];
  }
  void count(double w, double we2, std::size_t n) {
    sums_.weight += w;
    sums_.squared_error += we2;
    sums_.count += n;
  }

  NormalEquations& sums_;
  bool velocity_;
  std::array<Row, kRows> rows_;
  std::size_t used_ = 0;
};

}  // namespace rilo
