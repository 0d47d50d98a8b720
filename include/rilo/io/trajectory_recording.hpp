// A run as a recording with the message types of ROS.
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
/// given the pose before about the axes of the odometry frame, velocity in the LiDAR frame and its covariance over the
/// step from the pose before, see ros_twist_covariance()) and tf2_msgs/msg/TFMessage (odom_frame → lidar_frame), each
/// at the time of the pose. Stamps before 1970 become 0 and those after 2038 the last that the messages know. Lost and
/// empty sweeps are in it: their covariance marks them as guesses.
/// @throws IoError when it cannot be written.
void write_mcap(const std::filesystem::path& file, std::span<const SweepResult> results,
                const RecordingNames& names = {});

/// Whether this build writes ROS 1 bags: it does where ROS' own library was found.
bool can_write_bags();

/// The same as a ROS 1 bag: nav_msgs/Odometry and tf2_msgs/TFMessage. ROS 1 has no time before 1970, none after 2106
/// and no message at time 0: such stamps are moved to the nearest that it has.
/// @throws IoError when it cannot be written, or where can_write_bags() is false.
void write_bag(const std::filesystem::path& file, std::span<const SweepResult> results,
               const RecordingNames& names = {});

}  // namespace rilo
