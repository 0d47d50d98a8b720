// Covariances and twists in the order and the axes that ROS wants.
#pragma once

#include "rilo/geometry/se3.hpp"

namespace rilo {

/// geometry_msgs/PoseWithCovariance: `covariance` of a pose (right perturbation, [rad; m], as SweepResult::covariance)
/// as [position; rotation about fixed axes] about the axes of the parent frame.
Matrix6d ros_pose_covariance(const SE3& T_parent_body, const Matrix6d& covariance);

/// geometry_msgs/TwistWithCovariance: [rotation; translation] becomes [translation; rotation]; the axes stay the
/// body's.
Matrix6d ros_twist_covariance(const Matrix6d& covariance);

}  // namespace rilo
