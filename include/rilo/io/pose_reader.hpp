// Pose and calibration files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "rilo/geometry/se3.hpp"
#include "rilo/geometry/trajectory.hpp"

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

/// `Tr:` of a KITTI calib.txt: T_cam_lidar. Nothing when the file has no such line.
/// @throws IoError when the file cannot be read or the line is malformed.
std::optional<SE3> read_kitti_calibration(const std::filesystem::path& file);

/// One stamp a line, in seconds, read exactly to the nanosecond (KITTI's times.txt).
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file);

/// T_lidar = Tr^-1 · T_cam · Tr for every pose.
std::vector<SE3> camera_to_lidar(const std::vector<SE3>& T_world_cam, const SE3& T_cam_lidar);

}  // namespace rilo
