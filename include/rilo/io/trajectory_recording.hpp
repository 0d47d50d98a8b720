// A run as a recording with the message types of ROS 2, which Foxglove knows.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// Names of the frames and topics in a recording.
struct RecordingNames {
  std::string odom_frame = "odom";
  std::string lidar_frame = "lidar";
  std::string odometry_topic = "/odometry";
  std::string tf_topic = "/tf";
};

/// Writes `results` as an MCAP file: nav_msgs/msg/Odometry (pose of the LiDAR in the odometry frame, its covariance
/// given the pose before about the axes of the odometry frame, velocity in the LiDAR frame) and tf2_msgs/msg/TFMessage
/// (odom_frame → lidar_frame), each at the instant of the pose. Lost and empty sweeps are in it: their covariance says
/// that they are guesses.
/// @throws IoError when it cannot be written.
void write_mcap(const std::filesystem::path& file, std::span<const SweepResult> results,
                const RecordingNames& names = {});

}  // namespace rilo
