// Trajectories to files, whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/geometry/se3.hpp"
#include "rilo/geometry/trajectory.hpp"

namespace rilo {

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

}  // namespace rilo
