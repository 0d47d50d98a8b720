// True poses that lie beside the data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/geometry/se3.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// "start", "mid" or "end".
std::optional<PoseInstant> parse_pose_instant(std::string_view text);

/// True poses in the LiDAR frame; the i-th belongs to the i-th sweep of the data (ScanSource::current_index).
struct GroundTruth {
  std::vector<SE3> T_world_lidar;
  std::filesystem::path file;
  std::string instant;                ///< "start", "mid", "end" or "stamp": what the file's poses refer to
  std::vector<std::string> warnings;  ///< other time than asked for, fewer or more poses than sweeps
};

/// Looks for ground truth at that time of the sweeps in the data folder: poses_{start,mid,end}.txt of a drive
/// simulator, else poses_velo.txt (LiDAR frame), poses.txt (camera frame when calib.txt has `Tr`, else LiDAR frame),
/// else oxts/data of a KITTI raw drive with calib_imu_to_velo.txt in it or above it (LiDAR frame, the first pose is the
/// identity), else KITTI odometry's
/// ../../poses/NN.txt (camera frame). Nothing when there is none.
/// @throws IoError when a file is malformed, or is in another frame and there is no calibration.
std::optional<GroundTruth> read_ground_truth(const std::filesystem::path& data, PoseInstant instant);

}  // namespace rilo
