#include "rilo/geometry/se3.hpp"

#include <cmath>

namespace rilo {

namespace {

// Below this angle the closed forms lose digits to cancellation and their Taylor series are exact to double precision.
constexpr double kSmallAngleRad = 1e-4;  // below it the series are exact to double precision

/// V(phi) with t = V * rho in the exponential of SE(3) (the left Jacobian of SO(3)).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double theta2 = theta * theta;
  const Eigen::Matrix3d W = hat(phi);
  const double a = theta < kSmallAngleRad ? 0.5 - theta2 / 24.0 : (1.0 - std::cos(theta)) / theta2;
  const double b = theta < kSmallAngleRad ? 1.0 / 6.0 - theta2 / 120.0 : (theta - std::sin(theta)) / (theta2 * theta);
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double theta2 = theta * theta;
  const Eigen::Matrix3d W = hat(phi);
  const double half = 0.5 * theta;
  const double c =
      theta < kSmallAngleRad ? 1.0 / 12.0 + theta2 / 720.0 : (1.0 - half * std::cos(half) / std::sin(half)) / theta2;
  return Eigen::Matrix3d::Identity() - 0.5 * W + c * W * W;
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d W;
  W << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return W;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double theta2 = theta * theta;
  const Eigen::Matrix3d W = hat(phi);
  const double a = theta < kSmallAngleRad ? 1.0 - theta2 / 6.0 : std::sin(theta) / theta;
  const double b = theta < kSmallAngleRad ? 0.5 - theta2 / 24.0 : (1.0 - std::cos(theta)) / theta2;
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& R) {
  // The quaternion form is well conditioned over the whole range, pi included, where the trace form is not.
  Eigen::Quaterniond q(R);
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();
  }
  const double s = q.vec().norm();
  const double angle = 2.0 * std::atan2(s, q.w());
  return s < 1e-9 ? Eigen::Vector3d(2.0 / q.w() * q.vec()) : Eigen::Vector3d(angle / s * q.vec());
}

SE3 se3_exp(const Vector6d& xi) {
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(xi.head<3>());
  T.translation() = left_jacobian(xi.head<3>()) * xi.tail<3>();
  return T;
}

Vector6d se3_log(const SE3& T) {
  Vector6d xi;
  xi.head<3>() = so3_log(T.linear());
  xi.tail<3>() = left_jacobian_inverse(xi.head<3>()) * T.translation();
  return xi;
}

Matrix6d adjoint(const SE3& T) {
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = T.linear();
  A.bottomRightCorner<3, 3>() = T.linear();
  A.bottomLeftCorner<3, 3>() = hat(T.translation()) * T.linear();
  return A;
}

SE3 interpolate(const SE3& a, const SE3& b, double s) { return a * se3_exp(s * se3_log(a.inverse() * b)); }

SE3 renormalised(const SE3& T) {
  SE3 result = T;
  result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return result;
}

double rotation_angle_rad(const SE3& T) { return so3_log(T.linear()).norm(); }

}  // namespace rilo
