// Trajectories, poses, stamps and calibrations from and to files; written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/geometry/se3.hpp"
#include "rilo/geometry/trajectory.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// KITTI form: 12 numbers a line, the upper 3×4 of a pose, row by row. Blank lines and lines that begin with # are
/// passed over. The numbers are kept as they are (KITTI's have 7 digits).
/// @throws IoError with line and column: not 12 finite numbers, or not a rigid transform (tolerance 1e-3).
std::vector<SE3> read_kitti_poses(const std::filesystem::path& file);

/// The same for a file that may still be written to: a last line without its end is dropped.
std::vector<SE3> read_growing_kitti_poses(const std::filesystem::path& file);

/// TUM form: `t x y z qx qy qz qw` a line, t in seconds, read exactly to the nanosecond; the quaternion is normalised.
/// @throws IoError with line and column: not 8 finite numbers, quaternion norm off by more than 1e-3.
Trajectory read_tum(const std::filesystem::path& file);

/// EuRoC form: `ns,x,y,z,qw,qx,qy,qz` a line, what follows is passed over. Otherwise as read_tum.
Trajectory read_euroc(const std::filesystem::path& file);

/// `Tr:` of a KITTI calib.txt: T_cam_lidar. Nothing when the file has no such line.
/// @throws IoError when the file cannot be read or the line is malformed.
std::optional<SE3> read_kitti_calibration(const std::filesystem::path& file);

/// One stamp a line: seconds, read exactly to the nanosecond (KITTI's times.txt), whole ns (19 digits), µs (16) or ms
/// (13), or a date (2011-09-26 13:02:25.951199337, UTC). Blank lines and lines that begin with # are skipped.
/// @throws IoError with the line.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file);

/// T_lidar = Tr^-1 · T_cam · Tr for every pose.
std::vector<SE3> camera_to_lidar(const std::vector<SE3>& T_world_cam, const SE3& T_cam_lidar);

/// One pose in KITTI form: 12 numbers of 13 significant digits and the line break.
std::string kitti_line(const SE3& pose);

/// KITTI form (12 numbers per line, 13 significant digits), LiDAR frame.
void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory);
void write_kitti_poses(const std::filesystem::path& file, const std::vector<SE3>& poses);

/// KITTI form in the camera frame: Tr · T · Tr^-1.
void write_kitti_poses_camera(const std::filesystem::path& file, const Trajectory& trajectory, const SE3& T_cam_lidar);

/// TUM form `t x y z qx qy qz qw`; t in seconds with 9 decimals, exactly the int64 ns; qw >= 0.
void write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// EuRoC form: a comment line, then `timestamp [ns],x,y,z,qw,qx,qy,qz`; qw >= 0.
void write_euroc(const std::filesystem::path& file, const Trajectory& trajectory);

/// One stamp a line, seconds with 9 decimals (KITTI's times.txt).
void write_stamps(const std::filesystem::path& file, const std::vector<std::int64_t>& stamps_ns);

/// Seconds with 9 decimals, no rounding: 1500000000 -> "1.500000000".
std::string format_stamp(std::int64_t stamp_ns);

/// Decimal seconds ("-1.5", "1.6e9", "1317042145.964") to ns without going through floating point; digits beyond the
/// ninth decimal are rounded half away from zero. Nothing when the text is not a number or out of range.
std::optional<std::int64_t> parse_stamp(std::string_view text);

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
