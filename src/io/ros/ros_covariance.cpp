#include "io/ros/ros_covariance.hpp"

namespace rilo::detail {

// Ours has the rotation first and is about the axes of the sensor.
Matrix6d ros_covariance(const SweepResult& result) {
  const Eigen::Matrix3d R = result.T_odom_lidar.linear();
  Matrix6d turn = Matrix6d::Zero();
  turn.topRightCorner<3, 3>() = R;
  turn.bottomLeftCorner<3, 3>() = R;
  return turn * result.covariance * turn.transpose();
}

}  // namespace rilo::detail
