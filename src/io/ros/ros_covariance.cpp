#include "io/ros/ros_covariance.hpp"

namespace rilo {
namespace {

// Swaps rotation and translation, and rotates both.
Matrix6d swapped(const Eigen::Matrix3d& R, const Matrix6d& covariance) {
  Matrix6d rotation = Matrix6d::Zero();
  rotation.topRightCorner<3, 3>() = R;
  rotation.bottomLeftCorner<3, 3>() = R;
  return rotation * covariance * rotation.transpose();
}

}  // namespace

Matrix6d ros_pose_covariance(const SE3& T_parent_body, const Matrix6d& covariance) {
  return swapped(T_parent_body.linear(), covariance);
}

Matrix6d ros_twist_covariance(const Matrix6d& covariance, double step_s) {
  constexpr double kUnknownVariance = 1e6;
  if (!(step_s > 0)) return kUnknownVariance * Matrix6d::Identity();
  return swapped(Eigen::Matrix3d::Identity(), covariance) / (step_s * step_s);
}

}  // namespace rilo
