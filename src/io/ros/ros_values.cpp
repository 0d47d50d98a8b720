#include "io/ros/ros_values.hpp"

#include <algorithm>

#include "io/stamp_difference.hpp"

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

detail::MessageStamp detail::message_stamp(std::int64_t stamp_ns, std::int64_t least_ns, std::uint32_t last_second) {
  const std::int64_t last_ns = (std::int64_t{last_second} + 1) * kNanosecondsPerSecond - 1;
  const std::int64_t known = std::clamp(stamp_ns, least_ns, last_ns);
  return {static_cast<std::uint32_t>(known / kNanosecondsPerSecond),
          static_cast<std::uint32_t>(known % kNanosecondsPerSecond)};
}

Matrix6d ros_pose_covariance(const SE3& T_parent_body, const Matrix6d& covariance) {
  return swapped(T_parent_body.linear(), covariance);
}

Matrix6d ros_twist_covariance(const Matrix6d& covariance, double step_s) {
  constexpr double kUnknownVariance = 1e6;
  if (!(step_s > 0)) return kUnknownVariance * Matrix6d::Identity();
  return swapped(Eigen::Matrix3d::Identity(), covariance) / (step_s * step_s);
}

}  // namespace rilo
