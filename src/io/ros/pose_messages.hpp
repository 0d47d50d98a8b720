// The messages of a sweep's pose, which both ROS share.
#pragma once

#include <cstddef>
#include <span>

#include "io/ros/message_writer.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {

/// nav_msgs/Odometry of results[i]; its velocity covers the step from the pose before it.
MessageWriter odometry_message(MessageEncoding encoding, std::span<const SweepResult> results, std::size_t i,
                               const RecordingNames& names);

/// tf2_msgs/TFMessage of one transform, that of results[i].
MessageWriter transform_message(MessageEncoding encoding, std::span<const SweepResult> results, std::size_t i,
                                const RecordingNames& names);

}  // namespace rilo::detail
