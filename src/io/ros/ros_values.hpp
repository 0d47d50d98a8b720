// Stamps and covariances as the messages of ROS have them.
#pragma once

#include <cstdint>

#include "rilo/geometry/se3.hpp"

namespace rilo {
namespace detail {

inline constexpr std::uint32_t kLastRos1Second = 0xFFFFFFFF;
inline constexpr std::uint32_t kLastRos2Second = 0x7FFFFFFF;  ///< builtin_interfaces/Time has int32

struct MessageStamp {
  std::uint32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
};

/// The nearest stamp that a message can have: from `least_ns` (0 or later: no library of ROS takes a negative time) to
/// the end of the second `last_second`.
MessageStamp message_stamp(std::int64_t stamp_ns, std::int64_t least_ns, std::uint32_t last_second);

}  // namespace detail

/// geometry_msgs/PoseWithCovariance: `covariance` of a pose (right perturbation, [rad; m], as SweepResult::covariance)
/// as [position; rotation about fixed axes] about the axes of the parent frame.
Matrix6d ros_pose_covariance(const SE3& T_parent_body, const Matrix6d& covariance);

/// geometry_msgs/TwistWithCovariance: the covariance of the velocity (m/s, rad/s; [translation; rotation], axes of the
/// body) from `covariance` of the pose given the pose before ([rad; m], as SweepResult::covariance), `step_s` seconds
/// earlier. Without a pose before (`step_s` not above 0) the velocity is unknown: a variance of 1e6 on each axis.
Matrix6d ros_twist_covariance(const Matrix6d& covariance, double step_s);

}  // namespace rilo
