#include "node/base_frame.hpp"

#include <utility>

namespace rilo {

std::string frame_name(std::string name) {
  if (!name.empty() && name.front() == '/') name.erase(0, 1);
  return name;
}

SE3 base_pose(const SE3& T_odom_lidar, const SE3& T_base_lidar, const SE3& T_world_odom) {
  return T_world_odom * T_base_lidar * T_odom_lidar * T_base_lidar.inverse();
}

SweepResult of_base(const SweepResult& result, const SE3& T_base_lidar, const SE3& T_world_odom) {
  SweepResult base = result;
  base.T_odom_lidar = base_pose(result.T_odom_lidar, T_base_lidar, T_world_odom);
  const Matrix6d to_base = adjoint(T_base_lidar);
  base.twist = to_base * result.twist;
  base.covariance = to_base * result.covariance * to_base.transpose();
  return base;
}

void transform_points(const SE3& T, std::vector<Eigen::Vector3f>& points) {
  if (T.isApprox(SE3::Identity(), 0)) return;
  for (Eigen::Vector3f& point : points) point = (T * point.cast<double>()).cast<float>();
}

}  // namespace rilo
