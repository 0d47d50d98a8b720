// Covariances and twists in the order and the axes that ROS wants.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// geometry_msgs/PoseWithCovariance: `covariance` of a pose (right perturbation, [rad; m], as SweepResult::covariance)
/// as [position; rotation about fixed axes] about the axes of the parent frame.
Matrix6d ros_pose_covariance(const SE3& T_parent_body, const Matrix6d& covariance);

/// geometry_msgs/TwistWithCovariance: the covariance of the velocity (m/s, rad/s; [translation; rotation], axes of the
/// body) from `covariance` of the pose given the pose before ([rad; m], as SweepResult::covariance), `step_s` seconds
/// earlier. Without a pose before (`step_s` not above 0) the velocity is unknown: a variance of 1e6 on each axis.
Matrix6d ros_twist_covariance(const Matrix6d& covariance, double step_s);

}  // namespace rilo
