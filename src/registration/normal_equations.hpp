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

/// Sums of weighted residuals e with Jacobian [J, s J], s the offset (s) of the point from the time of the pose, or the
/// lever of the velocity at that offset: the second block is the velocity. Only the lower triangles are read.
struct NormalEquations {
  Matrix6d H0 = Matrix6d::Zero();  ///< Σ w J Jᵀ
  Matrix6d H1 = Matrix6d::Zero();  ///< Σ w s J Jᵀ
  Matrix6d H2 = Matrix6d::Zero();  ///< Σ w s² J Jᵀ
  Vector6d b0 = Vector6d::Zero();  ///< Σ w J e
  Vector6d b1 = Vector6d::Zero();  ///< Σ w s J e
  double weight = 0;               ///< Σ w
  double squared_error = 0;        ///< Σ w e²
  std::size_t count = 0;           ///< residuals

  void add(const Vector6d& J, double e, double w) {
    const Vector6d wJ = w * J;
    H0 += wJ * J.transpose();
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

/// Adds residuals to normal equations a block at a time. Within a block sums are single-precision, eight elements of
/// a column at once: the noise of a residual is ten thousand times larger than what that rounds.
class ResidualBlock {
 public:
  /// `velocity`: false where all s are 0.
  explicit ResidualBlock(NormalEquations& sums, bool velocity = true) : sums_(sums), velocity_(velocity) {}

  /// A residual with J = [(q × d)ᵀ dᵀ]: of a point at `q` from the sensor along the direction `d`, in the same axes.
  void add(const Eigen::Vector3f& q, const Eigen::Vector3f& d, double e, double w, double s) {
    if (used_ == kRows) {
      flush();
    }
    const Eigen::Vector3f moment = q.cross(d);
    rows_[used_++] = {{moment.x(), moment.y(), moment.z(), d.x(), d.y(), d.z(), 0.0F, 0.0F},
                      static_cast<float>(w),
                      static_cast<float>(e),
                      static_cast<float>(s)};
    sums_.weight += w;
    sums_.squared_error += w * e * e;
    ++sums_.count;
  }

  /// Adds what has been gathered; afterwards the sums are complete.
  void flush();

 private:
  struct Row {
    std::array<float, 8> J{};  // two more than there are, so that a vector register holds them
    float w = 0.0F;
    float e = 0.0F;
    float s = 0.0F;
  };
  static constexpr std::size_t kRows = 32;
  static void sum(const Row* rows, std::size_t n, bool velocity, NormalEquations& sums);

  NormalEquations& sums_;
  bool velocity_;
  std::array<Row, kRows> rows_;
  std::size_t used_ = 0;
};

}  // namespace rilo
