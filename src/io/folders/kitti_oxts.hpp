// Ground truth of a KITTI raw drive from its GPS/IMU unit.
#pragma once

#include <filesystem>
#include <optional>

#include "io/folders/ground_truth.hpp"

namespace rilo::detail {

/// Poses of the LiDAR at the sweeps of `drive` (velodyne_points/data), the first the identity: oxts/data of the same
/// numbers in the Mercator projection of KITTI's development kit, and calib_imu_to_velo.txt in `drive` or the folder
/// above it. Nothing when `drive` has no oxts/data.
/// @throws IoError when the calibration or a sweep's file is missing or malformed, or when the drive is not
/// synchronised: oxts/data then has another number of files than timestamps.txt has sweeps.
std::optional<GroundTruth> kitti_raw_truth(const std::filesystem::path& drive);

}  // namespace rilo::detail
