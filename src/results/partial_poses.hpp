// poses_lidar.partial.txt: the poses of a run so far, in KITTI form, and which sweeps they are of.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "rilo/geometry/se3.hpp"

namespace rilo {

inline constexpr const char* kPartialPoses = "poses_lidar.partial.txt";

/// The line of a pose. A comment before it says the number of its sweep where that is not `expected`, the one after the
/// sweep before (0 at the beginning): sweeps may be skipped, at the beginning and between others.
std::string partial_pose_line(const SE3& T_odom_lidar, std::size_t sweep, std::size_t expected);

struct PosesSoFar {
  std::vector<SE3> poses;
  std::vector<std::size_t> sweeps;  ///< number of each pose's sweep in the data
};

/// The complete lines. @throws IoError when the file cannot be read or holds something else.
PosesSoFar read_partial_poses(const std::filesystem::path& file);

}  // namespace rilo
