// SE(3) on top of Eigen: exponential, logarithm, adjoint, interpolation.
//
// A twist is [rotation; translation] (rad, m), see docs/conventions.md. `T_a_b` maps points of frame b to frame a.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rilo {

using SE3 = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Skew-symmetric matrix of `v`: hat(v) * w == v.cross(w).
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Rotation of the rotation vector `phi` (rad), Rodrigues' formula.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi);

/// Rotation vector (rad, norm at most pi) of the rotation matrix `R`.
Eigen::Vector3d so3_log(const Eigen::Matrix3d& R);

/// Exponential of the twist `xi` = [rotation; translation].
SE3 se3_exp(const Vector6d& xi);

/// Twist [rotation; translation] with se3_exp(se3_log(T)) == T; the rotation's norm is at most pi.
Vector6d se3_log(const SE3& T);

/// Adjoint: se3_exp(adjoint(T) * xi) == T * se3_exp(xi) * T.inverse().
Matrix6d adjoint(const SE3& T);

/// Pose between `a` (s = 0) and `b` (s = 1) along the geodesic a * exp(s * log(a^-1 b)); s outside [0, 1] extrapolates.
SE3 interpolate(const SE3& a, const SE3& b, double s);

/// `T` with its rotation made orthonormal again (by way of the unit quaternion): long products of poses lose it bit by
/// bit.
SE3 renormalised(const SE3& T);

/// Angle of the rotation of `T` (rad, 0 … pi).
double rotation_angle_rad(const SE3& T);

}  // namespace rilo
